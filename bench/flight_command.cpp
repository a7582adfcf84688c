#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "app/cli/standard_input.h"
#include "bench/commands.h"
#include "bench/options/output_options.h"
#include "bench/suites/flight_suite.h"

namespace reljef::bench {
namespace {

struct FlightChoice {
    FlightOptions options;
    bool draws_at_once = false;
    OutputChoice outputs;
};

// `terrain` is as given: standard input has another name while it is read.
Result<void> run_flight_command(const FlightChoice& choice, const std::string& terrain,
                                const cli::Interrupt& interrupt) {
    const std::vector<cli::NamedFile> inputs{{"TERRAIN", choice.options.terrain.terrain},
                                             {"--path", choice.options.view.path}};
    if (auto good = check_outputs(choice.outputs, inputs); !good) {
        return good;
    }
    auto results = run_flight(choice.options, interrupt.token());
    if (!results) {
        return results.error();
    }
    results->options.terrain.terrain = terrain;
    if (results->times.drawing_ms.empty()) {
        return results->end.stopped.value_or(Error{"no frames found, some were expected"});
    }
    auto reported = report(figure_table(*results), choice.outputs);
    return reported ? check_files(*results) : reported;
}

} // namespace

cli::Command add_flight_command(CLI::App& program, cli::Interrupt& interrupt) {
    auto* arguments = program.add_subcommand(
        "flight", "frame time, tiles read and memory of a flight over a streamed terrain");
    auto choice = std::make_shared<FlightChoice>();
    cli::add_terrain_options(*arguments, choice->options.terrain);
    cli::add_index_option(*arguments, choice->options.terrain, session::IndexUse::existing);
    arguments->get_option("--no-index")
        ->description("do not use the index that 'reljef index' has made. By default it is used "
                      "where it is: errors of tiles are then known, and coarse tiles are not "
                      "averaged anew. Standard input has none");
    cli::add_view_options(*arguments, choice->options.view);
    arguments->get_option("--max-error")
        ->description("polygons: at most PX pixels of error, with as few triangles as possible "
                      "(none: every sample of a tile; 1 with --context cpu)");
    arguments->add_flag(
        "--no-wait", choice->draws_at_once,
        "draw each frame at once, with the tiles that are there, while others are read");
    add_output_options(*arguments, choice->outputs);
    arguments->callback([choice] {
        cli::check_view_options(choice->options.view);
        choice->options.waits_for_tiles = !choice->draws_at_once;
        if (choice->options.view.path.empty()) {
            throw CLI::ValidationError("flight: no --path found, one to fly along was expected");
        }
    });
    arguments->footer(
        "Each frame waits for all its tiles, as in reljef render. Waiting and drawing are timed\n"
        "separately. With --no-wait, frames are drawn as in reljef view, and the kept errors tell\n"
        "what the missing tiles cost. They are known only with an index ('reljef index').\n"
        "Memory is that of the process; what it used before the terrain was opened is subtracted.\n"
        "Examples:\n"
        "  reljef-bench flight srtm/ --path track.gpx --frames 6000 --memory 64 --json "
        "flight.json\n"
        "  reljef-bench flight alps.tif --placement plane --path flyover --frames 500 --context "
        "cpu "
        "--no-wait --html flight");
    return {arguments, [choice, &interrupt] {
                const std::string terrain = choice->options.terrain.terrain;
                return cli::with_standard_input(
                    choice->options.terrain.terrain, interrupt.token(),
                    [&] { return run_flight_command(*choice, terrain, interrupt); });
            }};
}

} // namespace reljef::bench
