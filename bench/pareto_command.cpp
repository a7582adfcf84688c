#include "bench/pareto_command.h"

#include <memory>

#include <CLI/CLI.hpp>

#include "bench/output_options.h"
#include "bench/pareto_suite.h"
#include "bench/suite_arguments.h"

namespace reljef::bench {
namespace {

constexpr glm::ivec2 quick_size{512, 384}; // four times as many settings have time

struct ParetoChoice {
    ParetoOptions options;
    std::vector<std::string> terrains; // empty: the default ones
    OutputChoice outputs;
};

void add_pareto_options(CLI::App& command, ParetoChoice& choice) {
    add_terrains_option(command, choice.terrains, "natural and urban");
    add_techniques_option(command, choice.options.techniques, "all, over their parameters' ranges");
    add_suite_options(command, choice.options.suite);
    add_output_options(command, choice.outputs);
}

Result<void> run_pareto_command(const ParetoChoice& choice, bool is_size_given,
                                const app::Interrupt& interrupt) {
    const auto inputs = terrain_files(choice.terrains);
    if (auto good = check_outputs(choice.outputs, inputs); !good) { // not after all the measuring
        return good;
    }
    ParetoOptions options = choice.options;
    if (!choice.terrains.empty()) {
        options.terrains = choice.terrains;
    }
    if (options.suite.quick && !is_size_given) {
        options.suite.size = quick_size;
    }
    options.suite.keep_views = !choice.outputs.html.empty();
    return report(run_pareto(options, interrupt.token()), choice.outputs);
}

} // namespace

app::Command add_pareto_command(CLI::App& program, app::Interrupt& interrupt) {
    auto* arguments = program.add_subcommand(
        "pareto", "time against error of every technique over its parameters' ranges");
    auto choice = std::make_shared<ParetoChoice>();
    add_pareto_options(*arguments, *choice);
    arguments->footer(
        "Each terrain is seen from the poses overview, oblique, low and grazing.\n"
        "The area is that below the front, time and error on logarithmic axes: 0 the best, 1 the "
        "worst.\n"
        "With --quick pictures are 512x384 unless --size says otherwise, and settings there is no "
        "time\n"
        "for are left out.\n"
        "Ctrl-C ends after the frame being drawn; the rows so far are shown and written.\n"
        "Examples:\n"
        "  reljef-bench pareto --quick\n"
        "  reljef-bench pareto --terrain N45E006.hgt --json pareto.json --html report\n"
        "  reljef-bench pareto --technique polygons:lods=1 --csv pareto.csv");
    return {arguments, [arguments, choice, &interrupt] {
                return run_pareto_command(*choice, arguments->count("--size") > 0, interrupt);
            }};
}

} // namespace reljef::bench
