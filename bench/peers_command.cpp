#include <memory>

#include <CLI/CLI.hpp>

#include "bench/baselines/baseline_suite.h"
#include "bench/commands.h"
#include "bench/options/output_options.h"
#include "bench/options/suite_arguments.h"

namespace reljef::bench {
namespace {

constexpr glm::ivec2 peers_quick_size{512, 384};

struct PeersChoice {
    BaselineOptions options;
    OutputChoice outputs;
};

Result<void> run_peers_command(const PeersChoice& choice, const CLI::App& command,
                               const cli::Interrupt& interrupt) {
    const std::vector<std::string> terrains{choice.options.terrain};
    if (auto good = check_outputs(choice.outputs, terrain_files(terrains)); !good) {
        return good;
    }
    BaselineOptions options = choice.options;
    options.suite = with_quick_size(options.suite, command, peers_quick_size);
    return report(figure_table(run_baselines(options, interrupt.token())), choice.outputs);
}

} // namespace

cli::Command add_peers_command(CLI::App& program, cli::Interrupt& interrupt) {
    auto* arguments = program.add_subcommand(
        "peers", "time and error of other programs beside reljef, on the same terrain");
    auto choice = std::make_shared<PeersChoice>();
    arguments
        ->add_option("--terrain", choice->options.terrain,
                     "natural, urban, a scene file (.toml) or a DEM file (natural)")
        ->type_name("TERRAIN");
    add_suite_options(*arguments, choice->options.suite);
    add_output_options(*arguments, choice->outputs);
    arguments->footer(
        "All draw the same 2^n+1 x 2^n+1 samples of the terrain's middle, without light, from the\n"
        "poses overview and low, one frame after the other. One table for each kind of work:\n"
        "  levels of triangles: Irrlicht's terrain node beside polygons, also with a moving "
        "camera\n"
        "  a vertex for every sample: OpenSceneGraph's terrain beside polygons\n"
        "  a flat square: Irrlicht's parallax material beside parallax\n"
        "  hits of rays: Embree beside exact on the CPU\n"
        "  a picture of rays: POV-Ray's height_field beside exact on the CPU. Its time is its own\n"
        "    'Trace Time': without its start and without reading the scene\n"
        "A program that is not installed is left out with a note: Irrlicht and OpenSceneGraph must "
        "be\n"
        "there when reljef is built (apt-get install libirrlicht-dev libopenscenegraph-dev), "
        "POV-Ray\n"
        "when the suite runs (apt-get install povray). The suite needs a display; xvfb-run "
        "provides\n"
        "one.\n"
        "Examples:\n"
        "  xvfb-run -a reljef-bench peers --terrain N45E006.hgt --json peers.json\n"
        "  xvfb-run -a reljef-bench peers --quick --html peers");
    return {arguments, [arguments, choice, &interrupt] {
                return run_peers_command(*choice, *arguments, interrupt);
            }};
}

} // namespace reljef::bench
