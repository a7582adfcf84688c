#include "bench/commands.h"

#include <memory>

#include <CLI/CLI.hpp>

#include "bench/output_options.h"
#include "bench/runner/gallery_tiles.h"
#include "bench/suite_arguments.h"
#include "bench/suites/pareto_suite.h"

namespace reljef::bench {
namespace {

constexpr glm::ivec2 pareto_quick_size{320, 240}; // ten times as many settings have time

struct ParetoChoice {
    ParetoOptions options;
    OutputChoice outputs;
};

void add_pareto_options(CLI::App& command, ParetoChoice& choice) {
    add_terrains_option(command, choice.options.terrains, "gallery, natural and urban", true);
    add_techniques_option(command, choice.options.techniques, "all, over their parameters' ranges");
    add_suite_options(command, choice.options.suite);
    add_output_options(command, choice.outputs);
}

Result<void> run_pareto_command(const ParetoChoice& choice, const CLI::App& command,
                                const cli::Interrupt& interrupt) {
    const auto inputs = terrain_files(choice.options.terrains);
    if (auto good = check_outputs(choice.outputs, inputs); !good) { // not after all the measuring
        return good;
    }
    ParetoOptions options = choice.options;
    if (!options.terrains.empty()) { // else there are all kinds
        expect_suited(options.techniques, options.terrains);
    }
    options.suite = with_quick_size(options.suite, command, pareto_quick_size);
    options.suite.keep_views = !choice.outputs.html.empty();
    return report(run_pareto(options, interrupt.token()), choice.outputs);
}

} // namespace

cli::Command add_pareto_command(CLI::App& program, cli::Interrupt& interrupt) {
    auto* arguments = program.add_subcommand(
        "pareto", "time against error of every technique over its parameters' ranges");
    auto choice = std::make_shared<ParetoChoice>();
    add_pareto_options(*arguments, *choice);
    arguments->footer(
        "Each terrain is seen from the poses overview, oblique, low and grazing; the gallery's "
        "tiles,\n"
        "copies of one over a square, from oblique: there stand the techniques and options of "
        "meshes.\n"
        "The area is that below the front, time and error on logarithmic axes: 0 the best, 1 the "
        "worst.\n"
        "With --quick pictures are 320x240 unless --size says otherwise, natural and urban have "
        "257\n"
        "samples a side unless --terrain names them, and settings there is no time for are left "
        "out,\n"
        "and named; every technique as it is by default comes first.\n"
        "Ctrl-C draws what was looked at once more, shows and writes the rows so far, and ends.\n"
        "Examples, the second with real DEMs beside the built-in terrains:\n"
        "  reljef-bench pareto --quick\n"
        "  reljef-bench pareto --terrain natural --terrain urban --terrain N45E006.hgt --html "
        "report\n"
        "  reljef-bench pareto --terrain N45E006.hgt --json pareto.json\n"
        "  reljef-bench pareto --technique polygons:lods=1 --csv pareto.csv");
    return {arguments, [arguments, choice, &interrupt] {
                return run_pareto_command(*choice, *arguments, interrupt);
            }};
}

} // namespace reljef::bench
