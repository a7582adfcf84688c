#include "bench/lod_command.h"

#include <array>
#include <charconv>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "bench/baselines/methods_suite.h"
#include "bench/output_options.h"
#include "bench/suite_arguments.h"
#include "bench/suites/growth.h"
#include "bench/suites/growth_report.h"
#include "bench/suites/lod_suite.h"
#include "bench/suites/promise.h"
#include "bench/suites/promise_report.h"
#include "bench/suites/selection_suite.h"
#include "engine/view/error_view.h"

namespace reljef::bench {
namespace {

constexpr glm::ivec2 lod_quick_size{512, 384};

struct LodChoice {
    SuiteOptions suite;
    std::vector<std::string> terrains; // empty: the default ones
    OutputChoice outputs;
    std::optional<int> poses;
    double error = 1.0;
    bool methods = false;
    bool growth = false;
    bool selection = false;
    int memory_megabytes = 512;
};

Result<void> run_poses(const LodChoice& choice, const cli::Interrupt& interrupt) {
    PromiseOptions options;
    options.suite = choice.suite;
    options.terrains = choice.terrains.empty() ? LodOptions{}.terrains : choice.terrains;
    options.poses = *choice.poses;
    options.error = choice.error;
    options.flight_errors = {0.25, 0.5, 1.0, 2.0, 4.0};
    return report(run_promise(options, interrupt.token()), choice.outputs.json);
}

Result<void> run_triangle_methods(const LodChoice& choice, const cli::Interrupt& interrupt) {
    MethodsOptions options;
    options.suite = choice.suite;
    options.terrains = choice.terrains.empty() ? LodOptions{}.terrains : choice.terrains;
    return report(run_methods(options, interrupt.token()), choice.outputs.json);
}

Result<void> run_selection_command(const LodChoice& choice, const cli::Interrupt& interrupt) {
    SelectionOptions options;
    options.suite = choice.suite;
    options.rounds = choice.suite.quick ? 100 : options.rounds;
    return report(run_selection(options, interrupt.token()), choice.outputs.json);
}

Result<void> run_growth_command(const LodChoice& choice, const CLI::App& command,
                                const cli::Interrupt& interrupt) {
    GrowthOptions options;
    options.suite = with_quick_size(choice.suite, command, lod_quick_size);
    options.error = choice.error;
    options.memory_megabytes = choice.memory_megabytes;
    if (choice.suite.quick) {
        options.sides = {512, 1024, 4096};
    }
    return report(run_growth(options, interrupt.token()), choice.outputs.json,
                  choice.outputs.markdown);
}

Result<void> run_lod_command(const LodChoice& choice, const CLI::App& command,
                             const cli::Interrupt& interrupt) {
    const auto inputs = terrain_files(choice.terrains);
    if (auto good = check_outputs(choice.outputs, inputs); !good) { // not after all the measuring
        return good;
    }
    if (choice.poses) {
        return run_poses(choice, interrupt);
    }
    if (choice.methods) {
        return run_triangle_methods(choice, interrupt);
    }
    if (choice.selection) {
        return run_selection_command(choice, interrupt);
    }
    if (choice.growth) {
        return run_growth_command(choice, command, interrupt);
    }
    LodOptions options;
    options.suite = with_quick_size(choice.suite, command, lod_quick_size);
    options.suite.keep_views = !choice.outputs.html.empty();
    if (!choice.terrains.empty()) {
        options.terrains = choice.terrains;
    }
    return report(run_lod(options, interrupt.token()), choice.outputs);
}

void add_poses_options(CLI::App& command, LodChoice& choice) {
    command
        .add_option("--poses", choice.poses,
                    "instead of the tables: so many random poses, shared among the terrains, and "
                    "two flights over each, all held against --max-error pixel by pixel, the "
                    "flights against 0.25, 0.5, 1, 2 and 4 pixels")
        ->type_name("N")
        ->check(CLI::Range(1, 1'000'000));
    command.add_flag("--growth", choice.growth,
                     "instead of the tables: the same ground by 1024, 4096 and 16384 samples a "
                     "side, written to temporary files, looked at within --memory");
    command.add_option("--memory", choice.memory_megabytes, "of --growth, megabytes (512)")
        ->type_name("MB")
        ->check(CLI::Range(1, 1'000'000));
    command.add_option("--max-error", choice.error, "of --poses and --growth, pixels (1)")
        ->type_name("PX")
        ->check(CLI::Validator(
            [](const std::string& text) {
                double error = 0.0;
                const auto [end, code] =
                    std::from_chars(text.data(), text.data() + text.size(), error);
                const bool fits = code == std::errc{} && end == text.data() + text.size() &&
                                  error >= view::min_error && error <= view::max_error;
                return fits ? std::string()
                            : fmt::format("'{}' found, a number from {} to {} was expected", text,
                                          view::min_error, view::max_error);
            },
            ""));
}

void add_methods_option(CLI::App& command, LodChoice& choice) {
    command.add_flag("--methods", choice.methods,
                     "instead of the tables: triangles and the worst error of several ways to "
                     "triangulate, for errors of 0.3, 1 and 3 % of the height range");
    command.add_flag("--selection", choice.selection,
                     "instead of the tables: how long it takes to choose among 10,000 tiles what "
                     "is drawn");
}

[[noreturn]] void fail_usage(const std::string& message) {
    throw CLI::ValidationError(message);
}

// What is asked for instead of the tables; empty: the tables.
std::string table_instead(const LodChoice& choice) {
    const std::array asked{
        std::pair{choice.poses.has_value(), "--poses"}, std::pair{choice.methods, "--methods"},
        std::pair{choice.growth, "--growth"}, std::pair{choice.selection, "--selection"}};
    std::string instead;
    for (const auto& [is_asked, name] : asked) {
        if (is_asked && !instead.empty()) {
            fail_usage("--poses, --methods, --growth, --selection: more than one found, one was "
                       "expected");
        }
        instead = is_asked ? name : instead;
    }
    return instead;
}

void check_outputs_of(const std::string& instead, const OutputChoice& outputs) {
    const bool has_markdown = instead == "--growth";
    if (!outputs.csv.empty() || !outputs.html.empty() ||
        (!has_markdown && !outputs.markdown.empty())) {
        fail_usage(
            has_markdown
                ? "--growth: --csv or --html found, only --json and --markdown were expected "
                  "with it"
                : fmt::format("{}: --csv, --markdown or --html found, only --json was expected "
                              "with it",
                              instead));
    }
}

void check_lod_options(const LodChoice& choice, const CLI::App& command) {
    const std::string instead = table_instead(choice);
    if (!instead.empty()) {
        check_outputs_of(instead, choice.outputs);
    }
    if ((choice.growth || choice.selection) && !choice.terrains.empty()) {
        fail_usage(instead + ": --terrain found, none was expected with it");
    }
    if (!choice.poses && !choice.growth && command.count("--max-error") > 0) {
        fail_usage("--max-error: no --poses and no --growth found, one was expected with it");
    }
    if (!choice.growth && command.count("--memory") > 0) {
        fail_usage("--memory: no --growth found, one was expected with it");
    }
}

} // namespace

cli::Command add_lod_command(CLI::App& program, cli::Interrupt& interrupt) {
    auto* arguments = program.add_subcommand(
        "lod", "triangles, time and error of polygons by levels and by --max-error");
    auto choice = std::make_shared<LodChoice>();
    add_terrains_option(*arguments, choice->terrains, "natural and urban");
    add_suite_options(*arguments, choice->suite);
    add_output_options(*arguments, choice->outputs);
    add_poses_options(*arguments, *choice);
    add_methods_option(*arguments, *choice);
    arguments->callback([arguments, choice] { check_lod_options(*choice, *arguments); });
    arguments->footer(
        "Each terrain is seen from the poses overview, oblique, low and grazing, with a still "
        "camera. With --quick pictures are 512x384 unless --size says otherwise.\n"
        "Ctrl-C ends after the frame being drawn; the rows so far are shown and written.\n"
        "Examples:\n"
        "  reljef-bench lod --quick\n"
        "  reljef-bench lod --terrain N45E006.hgt --json lod.json\n"
        "  reljef-bench lod --terrain N45E006.hgt --poses 10000 --max-error 1\n"
        "  reljef-bench lod --terrain N45E006.hgt --terrain urban --methods\n"
        "  reljef-bench lod --growth --json growth.json\n"
        "  reljef-bench lod --selection");
    return {arguments, [arguments, choice, &interrupt] {
                return run_lod_command(*choice, *arguments, interrupt);
            }};
}

} // namespace reljef::bench
