#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/shard_option.h"
#include "bench/commands.h"
#include "bench/options/output_options.h"
#include "bench/options/part_options.h"
#include "bench/options/suite_arguments.h"
#include "bench/report/result_parts.h"
#include "bench/runner/gallery_tiles.h"
#include "bench/suites/pareto_suite.h"

namespace reljef::bench {
namespace {

constexpr glm::ivec2 pareto_quick_size{320, 240}; // there are ten times as many rows as in tables

struct ParetoChoice {
    ParetoOptions options;
    OutputChoice outputs;
    PartChoice part;
};

Result<void> merge_pareto(const ParetoChoice& choice, const CLI::App& command) {
    if (auto good = check_outputs(choice.outputs, merged_files(command, choice.part)); !good) {
        return good;
    }
    const auto all = read_result_parts(choice.part.merged);
    return all ? report(*all, choice.outputs) : all.error();
}

Result<void> run_pareto_command(const ParetoChoice& choice, const CLI::App& command,
                                const cli::Interrupt& interrupt) {
    if (!choice.part.merged.empty()) {
        return merge_pareto(choice, command);
    }
    const auto inputs = terrain_files(choice.options.terrains);
    const OutputChoice outputs = outputs_of_part(choice.outputs, choice.part);
    if (auto good = check_outputs(outputs, inputs); !good) {
        return good;
    }
    if (is_finished(outputs, choice.part, choice.options.suite.quiet)) {
        return {};
    }
    ParetoOptions options = choice.options;
    options.shard = choice.part.shard;
    if (!options.terrains.empty()) { // the default terrains suit every technique
        check_suited(options.techniques, options.terrains);
    }
    options.suite = with_quick_size(options.suite, command, pareto_quick_size);
    options.suite.keep_views = !outputs.html.empty();
    if (pareto_groups(options).empty() && !options.shard.is_whole()) {
        return Error{fmt::format("--shard: {} found, but there are fewer scenes and poses",
                                 cli::shard_text(options.shard))};
    }
    return report(run_pareto(options, interrupt.token()), outputs);
}

} // namespace

cli::Command add_pareto_command(CLI::App& program, cli::Interrupt& interrupt) {
    auto* arguments = program.add_subcommand(
        "pareto", "frame time against error of each technique over the ranges of its parameters");
    auto choice = std::make_shared<ParetoChoice>();
    add_terrains_option(*arguments, choice->options.terrains, "gallery, natural and urban", true);
    add_techniques_option(*arguments, choice->options.techniques,
                          "all techniques, over the ranges of their parameters");
    add_suite_options(*arguments, choice->options.suite);
    add_drawing_options(*arguments, choice->options.suite);
    add_output_options(*arguments, choice->outputs);
    add_part_options(*arguments, choice->part, "scenes and poses");
    arguments->footer(
        "The poses are overview, oblique, low and grazing; the gallery's detail textures are\n"
        "measured from oblique only, with the techniques and options for meshes.\n"
        "Area: the area below the Pareto front, time and error on logarithmic axes; 0 is best, 1\n"
        "is worst.\n"
        "--quick draws 320x240 pixels unless --size is given, and 257 samples a side of natural\n"
        "and urban unless --terrain is given. It measures the defaults of all techniques first,\n"
        "leaves out settings when time runs out, and reports them.\n"
        "Ctrl-C draws each finished setting once more; then the rows so far are printed and\n"
        "written.\n"
        "With --shard, processes measure parts; 'compare' reads the files of all parts as one "
        "run,\n"
        "and --merge reports them as one, in the page without pictures.\n"
        "Examples:\n"
        "  reljef-bench pareto --quick\n"
        "  reljef-bench pareto --terrain natural --terrain N45E006.hgt --html report\n"
        "  reljef-bench pareto --terrain N45E006.hgt --json pareto.json\n"
        "  reljef-bench pareto --technique polygons:lods=1 --csv pareto.csv\n"
        "  reljef-bench pareto --shard 2/8 --json 'part-%d.json' --resume\n"
        "  reljef-bench pareto --merge 'part-%d.json' --json pareto.json");
    return {arguments, [arguments, choice, &interrupt] {
                return run_pareto_command(*choice, *arguments, interrupt);
            }};
}

} // namespace reljef::bench
