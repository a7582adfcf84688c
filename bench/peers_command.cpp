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
    OutputChoice outputs; // only `json` is used
};

Result<void> run_peers_command(const PeersChoice& choice, const CLI::App& command,
                               const cli::Interrupt& interrupt) {
    const std::vector<std::string> terrains{choice.options.terrain};
    if (auto good = check_outputs(choice.outputs, terrain_files(terrains)); !good) {
        return good;
    }
    BaselineOptions options = choice.options;
    options.suite = with_quick_size(options.suite, command, peers_quick_size);
    return report(figure_table(run_baselines(options, interrupt.token())), choice.outputs.json);
}

} // namespace

cli::Command add_peers_command(CLI::App& program, cli::Interrupt& interrupt) {
    auto* arguments = program.add_subcommand(
        "peers", "frame time, triangles and error of polygons and of Irrlicht's terrain node");
    auto choice = std::make_shared<PeersChoice>();
    arguments
        ->add_option("--terrain", choice->options.terrain,
                     "natural, urban, a scene file (.toml) or a DEM file (natural)")
        ->type_name("TERRAIN");
    add_suite_options(*arguments, choice->options.suite);
    add_json_option(*arguments, choice->outputs);
    arguments->footer(
        "Both programs draw the same 2^n+1 x 2^n+1 samples of the terrain's middle from the poses\n"
        "overview and low, in two windows, one frame after the other: first with a still camera,\n"
        "then with a moving one. The suite needs a display; xvfb-run provides one. It also needs\n"
        "Irrlicht when reljef is built (apt-get install libirrlicht-dev).\n"
        "Example:\n"
        "  xvfb-run -a reljef-bench peers --terrain N45E006.hgt --json peers.json");
    return {arguments, [arguments, choice, &interrupt] {
                return run_peers_command(*choice, *arguments, interrupt);
            }};
}

} // namespace reljef::bench
