#include "bench/lod_command.h"

#include <memory>

#include <CLI/CLI.hpp>

#include "bench/lod_suite.h"
#include "bench/output_options.h"
#include "bench/suite_arguments.h"

namespace reljef::bench {
namespace {

constexpr glm::ivec2 lod_quick_size{512, 384};

struct LodChoice {
    SuiteOptions suite;
    std::vector<std::string> terrains; // empty: the default ones
    OutputChoice outputs;
};

Result<void> run_lod_command(const LodChoice& choice, const CLI::App& command,
                             const app::Interrupt& interrupt) {
    const auto inputs = terrain_files(choice.terrains);
    if (auto good = check_outputs(choice.outputs, inputs); !good) { // not after all the measuring
        return good;
    }
    LodOptions options;
    options.suite = with_quick_size(choice.suite, command, lod_quick_size);
    options.suite.keep_views = !choice.outputs.html.empty();
    if (!choice.terrains.empty()) {
        options.terrains = choice.terrains;
    }
    return report(run_lod(options, interrupt.token()), choice.outputs);
}

} // namespace

app::Command add_lod_command(CLI::App& program, app::Interrupt& interrupt) {
    auto* arguments = program.add_subcommand(
        "lod", "triangles, time and error of polygons by levels and by --max-error");
    auto choice = std::make_shared<LodChoice>();
    add_terrains_option(*arguments, choice->terrains, "natural and urban");
    add_suite_options(*arguments, choice->suite);
    add_output_options(*arguments, choice->outputs);
    arguments->footer(
        "Each terrain is seen from the poses overview, oblique, low and grazing, with a still "
        "camera. With --quick pictures are 512x384 unless --size says otherwise.\n"
        "Ctrl-C ends after the frame being drawn; the rows so far are shown and written.\n"
        "Examples:\n"
        "  reljef-bench lod --quick\n"
        "  reljef-bench lod --terrain N45E006.hgt --json lod.json");
    return {arguments, [arguments, choice, &interrupt] {
                return run_lod_command(*choice, *arguments, interrupt);
            }};
}

} // namespace reljef::bench
