#include <algorithm>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/cli/options.h"
#include "app/cli/parsed_option.h"
#include "app/cli/shard_option.h"
#include "bench/commands.h"
#include "bench/options/output_options.h"
#include "bench/options/part_options.h"
#include "bench/options/suite_arguments.h"
#include "bench/suites/skip_kinds.h"
#include "bench/suites/skip_suite.h"

namespace reljef::bench {
namespace {

constexpr glm::ivec2 skip_quick_size{320, 240};

struct SkipChoice {
    SkipOptions options;
    OutputChoice outputs;
    PartChoice part;
};

// Each once.
std::vector<std::string> kind_names() {
    std::vector<std::string> names;
    for (const SkipTest& test : skip_tests()) {
        for (const SkipKind& kind : test.kinds) {
            if (std::find(names.begin(), names.end(), kind.name) == names.end()) {
                names.emplace_back(kind.name);
            }
        }
    }
    return names;
}

void add_choices(CLI::App& command, SkipOptions& options) {
    command
        .add_option_function<std::vector<std::string>>(
            "--pose",
            [&options](const std::vector<std::string>& texts) {
                for (const std::string& text : texts) {
                    const auto pose = cli::parse_pose(text);
                    if (!pose) {
                        throw CLI::ValidationError(pose.error().message);
                    }
                    options.poses.push_back(*pose);
                }
            },
            "camera pose: overview, oblique, low, grazing, valley or map; may be repeated "
            "(overview, "
            "low, grazing and valley; with --quick low)")
        ->type_name("NAME")
        ->allow_extra_args(false);
    command
        .add_option("--kind", options.kinds,
                    fmt::format("kind of skipping to switch off; may be repeated: {} (all)",
                                fmt::join(kind_names(), ", ")))
        ->type_name("NAME")
        ->check(cli::one_of(kind_names()))
        ->allow_extra_args(false);
    cli::add_parsed(command, "--memory", options.memory_megabytes,
                    cli::number_in<int>("--memory", 1, 1'000'000),
                    "memory for the tests of streamed tiles, megabytes: files that need less are "
                    "not streamed (16)",
                    "MB");
}

Result<void> run_skip_command(const SkipChoice& choice, const CLI::App& command,
                              const cli::Interrupt& interrupt) {
    const auto inputs = terrain_files(choice.options.terrains);
    const OutputChoice outputs = outputs_of_part(choice.outputs, choice.part);
    if (auto good = check_outputs(outputs, inputs); !good) {
        return good;
    }
    if (is_finished(outputs, choice.part, choice.options.suite.quiet)) {
        return {};
    }
    SkipOptions options = choice.options;
    options.shard = choice.part.shard;
    options.suite = with_quick_size(options.suite, command, skip_quick_size);
    options.suite.keep_views = !outputs.html.empty();
    const Results results = run_skip(options, interrupt.token());
    auto reported = report(results, outputs);
    return reported ? check_same_pictures(results) : reported;
}

} // namespace

cli::Command add_skip_command(CLI::App& program, cli::Interrupt& interrupt) {
    auto* arguments = program.add_subcommand(
        "skip", "what each kind of skipping saves: the same picture with and without it");
    auto choice = std::make_shared<SkipChoice>();
    add_terrains_option(*arguments, choice->options.terrains, "natural and urban", false);
    add_choices(*arguments, choice->options);
    add_suite_options(*arguments, choice->options.suite);
    add_drawing_options(*arguments, choice->options.suite);
    add_output_options(*arguments, choice->outputs);
    add_part_options(*arguments, choice->part, "scenes and poses");
    arguments->footer(
        "Each test draws a picture with everything skipped, and without each kind of skipping in\n"
        "turn. The pictures must be the same; where floats round differently, hits must be within\n"
        "the error of rounding. The exit status is 1 if a picture is another one.\n"
        "Savings: milliseconds, taps, rays, triangles, bytes uploaded and bytes of files read.\n"
        "Tests of streams need a georeferenced DEM file of more than --memory.\n"
        "With --context cpu, only rays on the CPU are measured.\n"
        "Examples:\n"
        "  reljef-bench skip --quick\n"
        "  reljef-bench skip --terrain natural --terrain N45E006.hgt --json skip.json --html "
        "report\n"
        "  reljef-bench skip --kind beams --kind blocks --pose low");
    return {arguments, [arguments, choice, &interrupt] {
                return run_skip_command(*choice, *arguments, interrupt);
            }};
}

} // namespace reljef::bench
