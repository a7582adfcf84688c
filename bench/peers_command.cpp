#include "bench/commands.h"

#include <memory>

#include <CLI/CLI.hpp>

#include "bench/baselines/baseline_suite.h"
#include "bench/output_options.h"
#include "bench/suite_arguments.h"

namespace reljef::bench {
namespace {

constexpr glm::ivec2 peers_quick_size{512, 384};

struct PeersChoice {
    BaselineOptions options;
    OutputChoice outputs; // the JSON only
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
        "peers", "time, triangles and error of polygons beside Irrlicht's terrain node");
    auto choice = std::make_shared<PeersChoice>();
    arguments
        ->add_option("--terrain", choice->options.terrain,
                     "natural, urban, a scene file (.toml) or a DEM file (natural)")
        ->type_name("TERRAIN");
    add_suite_options(*arguments, choice->options.suite);
    arguments->add_option("--json", choice->outputs.json, "write the results there too")
        ->type_name("FILE");
    arguments->footer(
        "Both draw the same 2^n+1 x 2^n+1 samples from the terrain's middle, from the poses "
        "overview "
        "and\nlow, each in a window of its own, frames in turns, with a camera that is still and "
        "with "
        "one that\nmoves. Needs a display: xvfb-run makes one. Irrlicht is looked for when the "
        "project is configured\n(apt-get install libirrlicht-dev).\n"
        "Example:\n"
        "  xvfb-run -a reljef-bench peers --terrain N45E006.hgt --json peers.json");
    return {arguments, [arguments, choice, &interrupt] {
                return run_peers_command(*choice, *arguments, interrupt);
            }};
}

} // namespace reljef::bench
