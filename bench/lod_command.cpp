#include <array>
#include <memory>

#include "app/cli/parsed_option.h"
#include "app/cli/usage_error.h"
#include "bench/commands.h"
#include "bench/options/output_options.h"
#include "bench/options/suite_arguments.h"
#include "bench/runner/suite.h"
#include "bench/suites/error_bound.h"
#include "bench/suites/scaling.h"
#include "bench/suites/selection_suite.h"
#include "engine/view/error_view.h"

namespace reljef::bench {
namespace {

constexpr glm::ivec2 lod_quick_size{512, 384};
constexpr std::array lod_poses{scene::Pose::overview, scene::Pose::oblique, scene::Pose::low,
                               scene::Pose::grazing};

struct LodChoice {
    SuiteOptions suite;
    std::vector<std::string> terrains; // empty: the default ones
    OutputChoice outputs;
    std::optional<int> poses;
    double error = 1.0;
    bool automatic = false; ///< poses with auto
    bool scaling = false;
    bool selection = false;
    int memory_megabytes = 512;
};

std::vector<std::string> terrains_of(const LodChoice& choice) {
    return choice.terrains.empty() ? std::vector<std::string>{"natural", "urban"} : choice.terrains;
}

Result<void> check_error_bound(const LodChoice& choice, const std::stop_token& stop) {
    ErrorBoundOptions options;
    options.suite = choice.suite;
    options.terrains = terrains_of(choice);
    options.poses = *choice.poses;
    options.error = choice.error;
    options.automatic = choice.automatic;
    options.flight_errors = {0.25, 0.5, 1.0, 2.0, 4.0};
    const ErrorBoundResults results = run_error_bound(options, stop);
    auto reported = report(figure_table(results), choice.outputs);
    return reported && !results.within_bound()
               ? Error{"pixels farther off than stated, or holes, found; none were expected"}
               : reported;
}

Result<void> measure_selection(const LodChoice& choice, const std::stop_token& stop) {
    SelectionOptions options;
    options.suite = choice.suite;
    options.rounds = choice.suite.quick ? 100 : options.rounds;
    return report(figure_table(run_selection(options, stop)), choice.outputs);
}

Result<void> measure_scaling(const LodChoice& choice, const std::stop_token& stop) {
    ScalingOptions options;
    options.suite = choice.suite;
    options.error = choice.error;
    options.memory_megabytes = choice.memory_megabytes;
    if (choice.suite.quick) {
        options.sides = {512, 1024, 4096};
    }
    return report(figure_table(run_scaling(options, stop)), choice.outputs);
}

Result<void> measure_tables(const LodChoice& choice, const std::stop_token& stop) {
    std::vector<scene::Technique> techniques;
    for (const int levels : {1, 3, 5}) {
        techniques.push_back(scene::Technique{scene::Polygons{.max_levels = levels}});
    }
    for (const double error : {0.25, 0.5, 1.0, 2.0, 4.0}) {
        techniques.push_back(scene::Technique{scene::Polygons{.error = error}});
    }
    Suite suite{"lod", {}};
    for (const std::string& terrain : terrains_of(choice)) {
        for (const scene::Pose pose : lod_poses) {
            suite.groups.push_back({"", {terrain}, pose, candidates_of(techniques)});
        }
    }
    SuiteOptions options = choice.suite;
    options.keep_views = !choice.outputs.html.empty();
    return report(run_suite(suite, options, stop), choice.outputs);
}

Result<void> run_lod_command(LodChoice choice, const CLI::App& command,
                             const cli::Interrupt& interrupt) {
    const auto inputs = terrain_files(choice.terrains);
    if (auto good = check_outputs(choice.outputs, inputs); !good) {
        return good;
    }
    if (choice.poses) {
        return check_error_bound(choice, interrupt.token());
    }
    if (choice.selection) {
        return measure_selection(choice, interrupt.token());
    }
    choice.suite = with_quick_size(choice.suite, command, lod_quick_size);
    return choice.scaling ? measure_scaling(choice, interrupt.token())
                          : measure_tables(choice, interrupt.token());
}

void add_lod_options(CLI::App& command, LodChoice& choice) {
    cli::add_parsed(command, "--poses", choice.poses, cli::number_in<int>("--poses", 1, 1'000'000),
                    "instead of the tables: check --max-error at the pixels of N random views, "
                    "shared among the terrains, and check 0.25, 0.5, 1, 2 and 4 pixels along two "
                    "camera paths over each terrain",
                    "N");
    command.add_flag("--growth", choice.scaling,
                     "instead of the tables: the same terrain with 1024, 4096 and 16384 samples a "
                     "side, written to temporary files and viewed within --memory");
    command.add_flag("--selection", choice.selection,
                     "instead of the tables: time to select the visible ones of 10,000 tiles");
    command.add_flag("--auto", choice.automatic, "--poses of the technique auto, not of polygons");
    cli::add_parsed(command, "--memory", choice.memory_megabytes,
                    cli::number_in<int>("--memory", 1, 1'000'000),
                    "memory budget of --growth, MB (512)", "MB");
    cli::add_parsed(command, "--max-error", choice.error,
                    cli::number_in("--max-error", view::min_error, view::max_error),
                    "error bound of --poses and --growth, pixels (1)", "PX");
}

// The option that replaces the tables; empty: none.
std::string replacement(const LodChoice& choice) {
    if (choice.poses.has_value() + choice.scaling + choice.selection > 1) {
        cli::fail_usage("--poses, --growth, --selection: more than one found, one was expected");
    }
    return choice.poses       ? "--poses"
           : choice.scaling   ? "--growth"
           : choice.selection ? "--selection"
                              : "";
}

void check_lod_options(const LodChoice& choice, const CLI::App& command) {
    const std::string option = replacement(choice);
    if ((choice.scaling || choice.selection) && !choice.terrains.empty()) {
        cli::fail_usage(option + ": --terrain found, none was expected with it");
    }
    if (!choice.poses && !choice.scaling && command.count("--max-error") > 0) {
        cli::fail_usage("--max-error: no --poses and no --growth found, one was expected with it");
    }
    if (!choice.poses && choice.automatic) {
        cli::fail_usage("--auto: no --poses found, one was expected with it");
    }
    if (!choice.scaling && command.count("--memory") > 0) {
        cli::fail_usage("--memory: no --growth found, one was expected with it");
    }
}

} // namespace

cli::Command add_lod_command(CLI::App& program, cli::Interrupt& interrupt) {
    auto* arguments = program.add_subcommand(
        "lod",
        "triangles, frame time and error of polygons by levels of detail and by error bound");
    auto choice = std::make_shared<LodChoice>();
    add_terrains_option(*arguments, choice->terrains, "natural and urban");
    add_suite_options(*arguments, choice->suite);
    add_drawing_options(*arguments, choice->suite);
    add_output_options(*arguments, choice->outputs);
    add_lod_options(*arguments, *choice);
    arguments->callback([arguments, choice] { check_lod_options(*choice, *arguments); });
    arguments->footer(
        "The poses are overview, oblique, low and grazing, with a still camera. --quick draws\n"
        "512x384 pixels unless --size is given.\n"
        "Ctrl-C ends after the current frame; the rows so far are printed and written.\n"
        "Examples:\n"
        "  reljef-bench lod --quick\n"
        "  reljef-bench lod --terrain N45E006.hgt --json lod.json\n"
        "  reljef-bench lod --terrain N45E006.hgt --poses 10000 --max-error 1\n"
        "  reljef-bench lod --growth --json growth.json --html growth\n"
        "  reljef-bench lod --selection --csv selection.csv");
    return {arguments, [arguments, choice, &interrupt] {
                return run_lod_command(*choice, *arguments, interrupt);
            }};
}

} // namespace reljef::bench
