#include "engine/session/terrain_index.h"

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

} // namespace

Result<IndexedTerrain> index_terrain(const SourceOptions& options, Log& log,
                                     const std::stop_token& stop) {
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
    auto source = open_heights(options, stop);
    if (!source) {
        return source.error();
    }
    for (const io::FileError& error : source->tiles.errors()) {
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
    const auto folder = io::cache_folder();
    if (!folder) {
        return Error{"$XDG_CACHE_HOME and $HOME: no absolute path found, one was expected for the "
                     "index"};
    }
    auto index = io::index_source(source->tiles, plan->grid, source->plan_options.gaps, *folder);
    if (!index) {
        return index.error();
    }
    const auto task = log.start("indexing " + description->name);
    auto report = io::make_index(*index, {.threads = static_cast<unsigned>(options.threads),
                                          .stop = stop,
                                          .progress = task->callback()});
    if (!report) {
        return report.error();
    }
    for (const io::FileError& error : report->errors) {
        log.message(MessageKind::left_out, error.message);
    }
    return IndexedTerrain{std::move(*report), {}, index->file, watch.seconds()};
}

} // namespace reljef::session
