#include "engine/session/terrain_index.h"

#include <algorithm>

#include <fmt/format.h>

#include "engine/core/stopwatch.h"
#include "engine/io/cache/disk_cache.h"
#include "engine/io/remote/read_scope.h"
#include "engine/session/terrain_source.h"

namespace reljef::session {
namespace {

IndexedTerrain needs_none(std::string reason) {
    return {{}, std::move(reason), {}, 0.0};
}

Result<std::filesystem::path> folder_of_indexes() {
    const auto folder = io::cache_folder();
    return folder ? Result<std::filesystem::path>(*folder)
                  : Error{"$XDG_CACHE_HOME and $HOME: no absolute path found, one was expected for "
                          "the index"};
}

Result<io::IndexSource> indexed_source(const TerrainSource& source) {
    const auto folder = folder_of_indexes();
    return folder ? io::index_source(*source.tiles, source.stream->plan.grid, source.stream->gaps,
                                     *folder)
                  : folder.error();
}

bool is_on_server(const io::TileSet& tiles) {
    return std::any_of(tiles.files().begin(), tiles.files().end(), [](const io::TileFile& file) {
        return file.path.string().find("://") != std::string::npos;
    });
}

using Proofs = std::shared_ptr<const ProvenTiles>;

Proofs proofs_of(const TerrainSource& source, io::IndexSource index, io::ErrorIndex found) {
    return std::make_shared<const ProvenTiles>(std::move(index), std::move(found),
                                               source.stream->imagery.refinement);
}

/// Null if there is no index; then reads nothing else.
Result<Proofs> existing_proofs(const TerrainSource& source) {
    const auto folder = io::cache_folder();
    const io::TileGrid& grid = source.stream->plan.grid;
    std::error_code ignored;
    if (!folder ||
        !std::filesystem::exists(io::index_file(*source.tiles, grid, source.stream->gaps, *folder),
                                 ignored)) {
        return Proofs();
    }
    auto index = indexed_source(source);
    if (!index) {
        return index.error();
    }
    auto found = io::ErrorIndex::open(*index);
    if (!found) {
        return found.error();
    }
    return *found ? proofs_of(source, std::move(*index), std::move(**found)) : Proofs();
}

unsigned threads_within(std::size_t memory_budget, unsigned threads) {
    const std::size_t max_threads =
        std::max<std::size_t>(1, memory_budget / io::bytes_of_index_thread);
    return static_cast<unsigned>(std::min<std::size_t>(thread_count(threads), max_threads));
}

Result<void> complete_index(const TerrainSource& source, const io::IndexSource& index,
                            unsigned threads, Log& log, const std::stop_token& stop) {
    if (is_on_server(index.tiles)) {
        return Error{fmt::format("{}: found on a server, a file that is here was expected for an "
                                 "index, which reads all of it; 'reljef index' makes one",
                                 index.tiles.name())};
    }
    const auto task = log.start("indexing " + source.description.name);
    const auto report =
        io::make_index(index,
                       {.threads = threads_within(source.stream->memory_budget, threads),
                        .stop = stop,
                        .progress = task->callback()},
                       {.shard = {}, .on_wait = [&] {
                            log.note(fmt::format("{}: another process indexes it now; waiting for "
                                                 "it, Ctrl-C ends this",
                                                 index.tiles.name()));
                        }});
    if (!report) {
        return report.error();
    }
    const auto& errors = report->errors;
    if (!errors.empty()) {
        const std::string more =
            errors.size() > 1 ? fmt::format(" (and {} more files)", errors.size() - 1) : "";
        const FileError& first = errors.front();
        const bool is_known =
            std::any_of(source.terrain.errors.begin(), source.terrain.errors.end(),
                        [&](const std::string& message) {
                            return message.starts_with(first.file.string() + ":");
                        });
        const std::string reason =
            is_known ? first.file.string() + " is not in the index" : first.message;
        log.note(unproven_note({reason + more}));
    }
    return {};
}

} // namespace

Result<IndexedTerrain> index_terrain(const SourceOptions& options, Log& log,
                                     const std::stop_token& stop, const Shard& shard) {
    const io::ReadScope scope(stop);
    const Stopwatch watch;
    const auto description = describe(options.terrain);
    if (!description) {
        return description.error();
    }
    if (!description->generator.empty()) {
        return needs_none(
            fmt::format("{} is generated in memory and needs no index", description->name));
    }
    auto source = open_heights(options, HeightUse::of_samples, stop);
    if (!source) {
        return source.error();
    }
    for (const FileError& error : source->tiles.errors()) {
        log.message(MessageKind::left_out, error.message);
    }
    const auto plan = source->tiles.plan(source->plan_options);
    if (!plan) {
        return plan.error();
    }
    if (plan->reduction == 1) {
        return needs_none(fmt::format("{} fits in --memory {} and needs no index",
                                      description->name, options.memory_megabytes));
    }
    const auto folder = folder_of_indexes();
    if (!folder) {
        return folder.error();
    }
    auto index = io::index_source(source->tiles, plan->grid, source->plan_options.gaps, *folder);
    if (!index) {
        return index.error();
    }
    const auto task = log.start("indexing " + description->name);
    const std::size_t memory_budget = static_cast<std::size_t>(options.memory_megabytes) << 20;
    const auto threads = static_cast<unsigned>(options.threads);
    auto report = io::make_index(*index,
                                 {.threads = threads_within(memory_budget, threads),
                                  .stop = stop,
                                  .progress = task->callback()},
                                 {.shard = shard});
    if (!report) {
        return report.error();
    }
    for (const FileError& error : report->errors) {
        log.message(MessageKind::left_out, error.message);
    }
    return IndexedTerrain{std::move(*report), {}, index->file, watch.seconds()};
}

Result<std::shared_ptr<const ProvenTiles>>
make_proofs(const TerrainSource& source, unsigned threads, Log& log, const std::stop_token& stop) {
    const io::ReadScope scope(stop);
    auto index = indexed_source(source);
    if (!index) {
        return index.error();
    }
    auto found = io::ErrorIndex::open(*index);
    if (!found || !*found || !(*found)->is_complete()) {
        if (found && *found && (*found)->is_damaged()) {
            log.note(fmt::format("{}: damaged parts found in the index, none were expected; it is "
                                 "made anew",
                                 index->file.string()));
        }
        if (auto made = complete_index(source, *index, threads, log, stop); !made) {
            return made.error();
        }
        found = io::ErrorIndex::open(*index);
    }
    if (!found) {
        return found.error();
    }
    return *found ? Result<Proofs>(proofs_of(source, std::move(*index), std::move(**found)))
                  : Error{fmt::format("{}: was removed meanwhile", index->file.string())};
}

Result<void> add_proofs(TerrainSource& source, bool makes_index, Log& log,
                        const std::stop_token& stop) {
    if (!source.stream) {
        return {};
    }
    auto proofs = makes_index ? make_proofs(source, source.stream->threads, log, stop)
                              : existing_proofs(source);
    if (stop.stop_requested()) {
        return Error{"interrupted"};
    }
    if (proofs) {
        source.proofs = std::move(*proofs);
    } else {
        log.note(unproven_note(proofs.error()));
    }
    return {};
}

std::string unproven_note(const Error& reason) {
    return reason.message + "; the errors of tiles are estimated";
}

} // namespace reljef::session
