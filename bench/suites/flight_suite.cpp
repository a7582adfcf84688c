#include "bench/suites/flight_suite.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/cli/console_log.h"
#include "app/cli/progress_line.h"
#include "bench/runner/benchmark_scene.h"
#include "engine/core/process_memory.h"
#include "engine/core/stopwatch.h"
#include "engine/scene/motion/camera_path.h"
#include "engine/session/flight_keys.h"
#include "engine/session/scene_setup.h"
#include "engine/session/streaming.h"

namespace reljef::bench {
namespace {

Result<session::DeviceFrames> flight_device(const FlightOptions& options, session::Log& log) {
    auto device = session::Device::create({.context = options.view.context,
                                           .size = options.view.size,
                                           .shader_dir = options.view.shader_dir,
                                           .threads = options.terrain.threads,
                                           .simd = options.view.simd});
    return device ? Result<session::DeviceFrames>(session::DeviceFrames(
                        std::move(*device), log,
                        {.timed = true, .waits_for_tiles = options.waits_for_tiles}))
                  : device.error();
}

Result<session::TerrainScene> flight_scene(const FlightOptions& options, session::Log& log,
                                           const std::stop_token& stop) {
    session::SourceOptions terrain = options.terrain;
    terrain.streamed = true;
    session::SceneOptions view = options.view;
    if (options.view.context == session::BackendKind::cpu) {
        view.rays = session::RayUse::only;
    } else if (!view.technique) {
        view.max_error = view.max_error.value_or(0.0); // every sample of a tile
    }
    return session::open_scene(terrain, view, log, stop);
}

Result<void> fly(session::TerrainScene& scene, const scene::CameraPath& path,
                 session::DeviceFrames& frames, session::Log& log, const Stopwatch& watch,
                 FlightResults& results, const std::stop_token& stop) {
    const int count = results.options.view.frames;
    const auto underground = results.options.view.allow_underground ? session::Underground::allowed
                                                                    : session::Underground::lifted;
    cli::ProgressLine line("flying", results.options.terrain.quiet);
    for (int index = 0; index < count && !stop.stop_requested(); ++index) {
        results.lifted.add(
            session::fly_above_ground(scene, path, index, count, frames, stop, underground));
        ParallelOptions parallel;
        parallel.stop = stop;
        if (const auto drawn = frames.draw(scene.scene, parallel); !drawn) {
            return drawn.error();
        }
        results.max_memory = std::max(results.max_memory, process_memory().now);
        const view::FrameStats& stats = frames.frame_stats();
        if (stats.kept_error) {
            results.kept_errors.push_back(*stats.kept_error);
        }
        results.max_tiles_unproven = std::max(results.max_tiles_unproven, stats.tiles_unproven);
        session::log_stream_errors(scene.scene, log);
        if (index == 0) {
            results.seconds_to_first_frame = watch.seconds();
        }
        line.update(static_cast<double>(index + 1) / count);
    }
    return {};
}

double megabytes(std::size_t bytes) {
    return static_cast<double>(bytes) * 1e-6;
}

std::vector<FigureColumn> flight_columns() {
    using namespace columns;
    return {group("/terrain", "terrain"),
            group("/path", "path"),
            plain("/frames", "frames"),
            less("/seconds", "all frames", "s"),
            less("/seconds_to_first_frame", "first frame after", "s"),
            less("/drawing_ms/median", "drawing, median", "ms"),
            less("/drawing_ms/p95", "drawing, p95", "ms"),
            less("/drawing_ms/p99", "drawing, p99", "ms"),
            less("/waiting_ms/median", "waiting for tiles, median", "ms"),
            less("/waiting_ms/p95", "waiting for tiles, p95", "ms"),
            less("/waiting_ms/p99", "waiting for tiles, p99", "ms"),
            plain("/tiles/read", "tiles read"),
            less("/tiles/failed", "tiles failed"),
            plain("/tiles/cancelled", "tiles cancelled"),
            plain("/tiles/evicted", "tiles evicted"),
            less("/tiles/bytes_read", "files read", "bytes", 1),
            less("/tiles/max_bytes", "tiles in memory, at most", "bytes", 1),
            less("/kept_error_px", "kept error, at most", "px"),
            less("/median_kept_error_px", "kept error, median", "px"),
            less("/tiles_unproven", "unproven tiles, at most"),
            less("/faulty_files", "faulty files"),
            detail(plain("/memory/allowed", "memory allowed", "bytes", 1)),
            detail(plain("/memory/before", "memory before", "bytes", 1)),
            less("/memory/max", "memory, at most", "bytes", 1),
            less("/memory/share_of_allowed", "memory, share of the allowed")};
}

void add_summary(FigureJson& row, const std::vector<double>& ms) {
    const Summary summary = summarize(ms);
    for (const double figure : {summary.median, summary.p95, summary.p99}) {
        row.push_back(figure);
    }
}

void add_stream(FigureJson& row, const std::optional<scene::TileStreamStats>& stats) {
    const std::vector<FigureJson> figures =
        stats ? std::vector<FigureJson>{stats->read,    stats->failed,     stats->cancelled,
                                        stats->evicted, stats->bytes_read, stats->max_bytes}
              : std::vector<FigureJson>(6);
    for (const FigureJson& figure : figures) {
        row.push_back(figure);
    }
}

std::string index_state(const scene::TileStreamOptions& stream) {
    return stream.find_proof == nullptr ? "none" : stream.is_all_proven ? "whole" : "partial";
}

} // namespace

Result<FlightResults> run_flight(const FlightOptions& options, const std::stop_token& stop) {
    cli::ConsoleLog log(options.terrain.quiet);
    auto frames = flight_device(options, log);
    if (!frames) {
        return frames.error();
    }
    const Stopwatch watch;
    auto scene = flight_scene(options, log, stop);
    if (!scene) {
        return scene.error();
    }
    const auto path = session::open_path(*scene, options.view.path, log);
    if (!path) {
        return path.error();
    }
    FlightResults results;
    results.options = options;
    results.environment = environment_of(frames->device(), options.terrain.threads);
    if (auto flown = fly(*scene, *path, *frames, log, watch, results, stop); !flown) {
        return flown.error();
    }
    results.seconds = watch.seconds();
    if (const auto good = results.lifted.report(log, options.view.path); !good) {
        log.note(good.error().message); // the times are still valid
    }
    results.times = frames->times();
    results.end = run_end({}, stop, !results.times.drawing_ms.empty());
    results.failed_files = scene->failed_files + session::failed_files(scene->scene);
    results.max_memory =
        std::max({results.max_memory, process_memory().peak, results.times.memory_before});
    const auto& stream = scene->terrain->get<scene::TerrainNode>()->stream;
    if (stream != nullptr) {
        results.stream = stream->stats();
        results.index = index_state(stream->options());
    }
    return results;
}

Result<void> check_files(const FlightResults& results) {
    return session::report_errors(results.options.terrain.terrain, results.failed_files);
}

FigureTable figure_table(const FlightResults& results) {
    const FlightOptions& options = results.options;
    const std::size_t budget = static_cast<std::size_t>(options.terrain.memory_megabytes) << 20U;
    const double share = (static_cast<double>(results.max_memory) -
                          static_cast<double>(results.times.memory_before)) /
                         static_cast<double>(budget);
    FigureTable table{.suite = "flight",
                      .environment = results.environment,
                      .shard = {},
                      .settings = {{"size", size_text(options.view.size)},
                                   {"waits_for_tiles", options.waits_for_tiles},
                                   {"index", results.index}},
                      .summary = {},
                      .columns = flight_columns()};
    table.end = results.end;
    if (results.times.drawing_ms.empty()) {
        return table;
    }
    FigureJson row{options.terrain.terrain, options.view.path, results.times.drawing_ms.size(),
                   results.seconds, results.seconds_to_first_frame};
    add_summary(row, results.times.drawing_ms);
    add_summary(row, results.times.waiting_ms);
    add_stream(row, results.stream);
    const std::vector<double>& errors = results.kept_errors;
    row.push_back(errors.empty() ? FigureJson() : FigureJson(*std::ranges::max_element(errors)));
    row.push_back(errors.empty() ? FigureJson() : FigureJson(summarize(errors).median));
    for (const std::size_t count :
         {static_cast<std::size_t>(results.max_tiles_unproven), results.failed_files, budget,
          results.times.memory_before, results.max_memory}) {
        row.push_back(count);
    }
    row.push_back(share);
    table.rows.push_back(std::move(row));
    table.notes.push_back(fmt::format(
        "Memory: {:.1f} MB at most, {:.1f} MB before the terrain was read: {:.0f} % of the {} MiB "
        "allowed.",
        megabytes(results.max_memory), megabytes(results.times.memory_before), 100.0 * share,
        options.terrain.memory_megabytes));
    return table;
}

} // namespace reljef::bench
