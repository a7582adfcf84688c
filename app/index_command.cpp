#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/cli/console_log.h"
#include "app/cli/options.h"
#include "app/cli/shard_option.h"
#include "app/commands.h"
#include "engine/session/terrain_index.h"

namespace reljef::app {
namespace {

using Json = nlohmann::ordered_json;

struct IndexChoice {
    cli::TerrainChoice terrain;
    bool json = false;
    Shard shard;
};

struct TileCount {
    std::size_t tiles = 0;
    std::size_t unproven = 0;
};

TileCount count_of(const io::IndexReport& report) {
    TileCount count;
    for (const auto& level : report.levels) {
        count.tiles += level.tiles;
        count.unproven += level.unproven;
    }
    return count;
}

// Of the proven tiles of a level, metres; empty if there are none.
std::optional<double> max_error_of(const io::ErrorIndex::Level& level) {
    return level.unproven < level.tiles ? std::optional(level.max_error) : std::nullopt;
}

Json json_of(const session::IndexedTerrain& indexed) {
    const io::IndexReport& report = *indexed.report;
    Json levels = Json::array();
    for (const auto& level : report.levels) {
        const auto error = max_error_of(level);
        levels.push_back({{"tiles", level.tiles},
                          {"unproven", level.unproven},
                          {"max_error_m", error ? Json(*error) : Json()}});
    }
    return {{"file", indexed.file.string()},
            {"bytes_of_errors", report.bytes_of_proofs},
            {"bytes_of_heights", report.bytes_of_heights},
            {"seconds", indexed.seconds},
            {"levels", std::move(levels)}};
}

void print_report(const session::IndexedTerrain& indexed) {
    constexpr double megabyte = 1 << 20;
    const io::IndexReport& report = *indexed.report;
    const TileCount count = count_of(report);
    fmt::print("{:<8}{:>10}{:>10}{:>18}\n", "level", "tiles", "unproven", "largest error, m");
    for (std::size_t level = 0; level < report.levels.size(); ++level) {
        const auto& found = report.levels[level];
        const auto error = max_error_of(found);
        fmt::print("{:<8}{:>10}{:>10}{:>18}\n", level, found.tiles, found.unproven,
                   error ? fmt::format("{:.3f}", *error) : "unknown");
    }
    fmt::print("{} tiles, {} unproven; errors {:.2f} MB, heights {:.1f} MB; {:.1f} s\n{}\n",
               count.tiles, count.unproven, static_cast<double>(report.bytes_of_proofs) / megabyte,
               static_cast<double>(report.bytes_of_heights) / megabyte, indexed.seconds,
               indexed.file.string());
}

Result<void> print_index(const IndexChoice& choice, const cli::Interrupt& interrupt) {
    cli::ConsoleLog log(choice.terrain.quiet);
    const auto indexed =
        session::index_terrain(choice.terrain, log, interrupt.token(), choice.shard);
    if (!indexed) {
        return indexed.error();
    }
    if (!indexed->report) {
        const std::string none =
            choice.json ? Json({{"reason", indexed->reason}}).dump(2) : indexed->reason;
        fmt::print("{}\n", none);
        return {};
    }
    if (choice.json) {
        fmt::print("{}\n", json_of(*indexed).dump(2, ' ', false, Json::error_handler_t::replace));
    } else {
        print_report(*indexed);
    }
    const TileCount count = count_of(*indexed->report);
    const bool is_for_others = !choice.shard.is_whole() && indexed->report->errors.empty();
    if (count.unproven > 0 && is_for_others) {
        log.note(
            fmt::format("part {} is done; {} of {} tiles are those of other parts, or wait for "
                        "them",
                        cli::shard_text(choice.shard), count.unproven, count.tiles));
    }
    return count.unproven == 0 || is_for_others
               ? Result<void>()
               : Error{fmt::format("{}: {} of {} tiles remain unproven, because {} could not be "
                                   "read; the same command tries them again",
                                   choice.terrain.terrain, count.unproven, count.tiles,
                                   indexed->report->errors.size() == 1 ? "a file" : "files")};
}

} // namespace

cli::Command add_index_command(CLI::App& program, cli::Interrupt& interrupt) {
    auto* arguments =
        program.add_subcommand("index", "prove the errors of the tiles of a large terrain");
    auto choice = std::make_shared<IndexChoice>();
    cli::add_source_options(*arguments, choice->terrain);
    cli::add_gaps_option(*arguments, choice->terrain);
    arguments->add_flag("--json", choice->json, "print JSON");
    cli::add_shard_option(*arguments, choice->shard, "tiles");
    arguments->callback([choice] {
        if (choice->terrain.terrain == "-") {
            throw CLI::ValidationError(
                "index: - found, a terrain that remains after the command was expected");
        }
    });
    arguments->footer(
        "Reads all samples once. For each tile of a terrain that does not fit --memory, it "
        "computes the range of heights and the largest error of the tile's surface, and the "
        "heights of coarse tiles. The results are kept in the cache folder. After Ctrl-C, the "
        "same command goes on where it stopped. Terrains that fit need no index.\n"
        "With --shard, several processes that share the cache folder make one index. The last one "
        "that ends completes it. If one was killed, the same command, or one without --shard, "
        "does what is missing.\n"
        "Examples:\n"
        "  reljef index alps.tif\n"
        "  reljef index tiles/ --area 44,6,46,8 --memory 256\n"
        "  reljef index alps.tif --json\n"
        "  mpirun -n 4 reljef index alps.tif --shard openmpi");
    return {arguments, [choice, &interrupt] { return print_index(*choice, interrupt); }};
}

} // namespace reljef::app
