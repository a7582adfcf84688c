#include "bench/suites/flight_suite.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/cli/console_log.h"
#include "app/cli/message.h"
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

FigureJson stream_json(const scene::TileStreamStats& stats) {
    return {{"read", stats.read},
            {"failed", stats.failed},
            {"cancelled", stats.cancelled},
            {"evicted", stats.evicted},
            {"bytes_read", stats.bytes_read},
            {"most_bytes", stats.max_bytes}};
}

double megabytes(std::size_t bytes) {
    return static_cast<double>(bytes) * 1e-6;
}

std::string times_line(std::string_view what, const std::vector<double>& ms) {
    const Summary summary = summarize(ms);
    return fmt::format("{}: median {:.2f} ms, p95 {:.2f}, p99 {:.2f}\n", what, summary.median,
                       summary.p95, summary.p99);
}

std::string heading(const FlightResults& results) {
    const FlightOptions& options = results.options;
    std::string text = fmt::format(
        "{}, {}, {}, {} threads\nframes: {} in {:.1f} s, the first after {:.2f} s\n",
        cli::printable(options.terrain.terrain), size_text(options.view.size),
        cli::printable(results.environment.renderer), results.environment.threads,
        results.times.drawing_ms.size(), results.seconds, results.seconds_to_first_frame);
    text += times_line("drawing", results.times.drawing_ms);
    text += times_line("waiting for tiles", results.times.waiting_ms);
    if (const auto& stream = results.stream) {
        text += fmt::format("tiles: {} read ({:.1f} MB of files), {} failed, {} cancelled, {} "
                            "evicted, at most {:.1f} MB\n",
                            stream->read, megabytes(stream->bytes_read), stream->failed,
                            stream->cancelled, stream->evicted, megabytes(stream->max_bytes));
    }
    if (const std::vector<double>& errors = results.kept_errors; !errors.empty()) {
        text += fmt::format("kept error: median {:.2f} px, at most {:.2f}, unproven tiles: at most "
                            "{}\n",
                            summarize(errors).median, *std::ranges::max_element(errors),
                            results.max_tiles_unproven);
    }
    text.pop_back();
    return text;
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
    results.failed_files = session::failed_files(scene->scene);
    results.max_memory =
        std::max({results.max_memory, process_memory().peak, results.times.memory_before});
    const auto& stream = scene->terrain->get<scene::TerrainNode>()->stream;
    if (stream != nullptr) {
        results.stream = stream->stats();
    }
    return results;
}

FigureTable figure_table(const FlightResults& results) {
    const FlightOptions& options = results.options;
    const std::size_t budget = static_cast<std::size_t>(options.terrain.memory_megabytes) << 20U;
    const double share = (static_cast<double>(results.max_memory) -
                          static_cast<double>(results.times.memory_before)) /
                         static_cast<double>(budget);
    const std::vector<double>& errors = results.kept_errors;
    const FigureJson none(nullptr);
    FigureTable table{
        .schema = "reljef-bench-flight/1",
        .heading = heading(results),
        .settings = {{"environment", json_of(results.environment)},
                     {"terrain", options.terrain.terrain},
                     {"path", options.view.path},
                     {"size", size_text(options.view.size)},
                     {"frames", results.times.drawing_ms.size()},
                     {"seconds", results.seconds},
                     {"seconds_to_first_frame", results.seconds_to_first_frame},
                     {"drawing_ms", json_of(summarize(results.times.drawing_ms))},
                     {"waiting_ms", json_of(summarize(results.times.waiting_ms))},
                     {"tiles", results.stream ? stream_json(*results.stream) : FigureJson()},
                     {"waits_for_tiles", options.waits_for_tiles},
                     {"kept_error_px",
                      errors.empty() ? none : FigureJson(*std::ranges::max_element(errors))},
                     {"median_kept_error_px",
                      errors.empty() ? none : FigureJson(summarize(errors).median)},
                     {"tiles_unproven", results.max_tiles_unproven},
                     {"faulty_files", results.failed_files},
                     {"memory",
                      {{"allowed", budget},
                       {"before", results.times.memory_before},
                       {"most", results.max_memory},
                       {"share_of_allowed", share}}}},
        .end = results.end};
    table.summary = fmt::format(
        "memory: {:.1f} MB at most, {:.1f} MB before the terrain was read: {:.0f} % of the {} MiB "
        "allowed\n",
        megabytes(results.max_memory), megabytes(results.times.memory_before), 100.0 * share,
        options.terrain.memory_megabytes);
    return table;
}

Result<void> report(const FlightResults& results, const std::filesystem::path& json) {
    if (results.times.drawing_ms.empty()) {
        return results.end.stopped.value_or(Error{"no frames found, some were expected"});
    }
    auto reported = report(figure_table(results), json);
    return reported ? session::report_errors(results.options.terrain.terrain, results.failed_files)
                    : reported;
}

} // namespace reljef::bench
