#include "bench/suites/flight_suite.h"

#include <algorithm>

#include "app/cli/console_log.h"
#include "app/cli/progress_line.h"
#include "engine/core/process_memory.h"
#include "engine/core/stopwatch.h"
#include "engine/scene/motion/animators.h"
#include "engine/session/scene_setup.h"
#include "engine/session/streaming.h"

namespace reljef::bench {
namespace {

Result<session::DeviceFrames> flight_device(const FlightOptions& options, session::Log& log) {
    auto device = session::Device::create({.context = options.view.context,
                                           .size = options.view.size,
                                           .shader_dir = options.view.shader_dir,
                                           .threads = options.terrain.threads});
    return device ? Result<session::DeviceFrames>(
                        session::DeviceFrames(std::move(*device), log, {.timed = true}))
                  : device.error();
}

Result<session::TerrainScene> flight_scene(const FlightOptions& options, session::Log& log,
                                           const std::stop_token& stop) {
    session::SourceOptions terrain = options.terrain;
    terrain.streamed = true;
    session::SceneOptions view = options.view;
    if (!view.technique) {
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
        results.raised.add(
            session::fly_above_ground(scene, path, index, count, frames, stop, underground));
        ParallelOptions parallel;
        parallel.stop = stop;
        if (const auto drawn = frames.draw(scene.scene, parallel); !drawn) {
            return drawn.error();
        }
        results.max_memory = std::max(results.max_memory, process_memory().now);
        session::log_stream_errors(scene.scene, log);
        if (index == 0) {
            results.seconds_to_first_frame = watch.seconds();
        }
        line.update(static_cast<double>(index + 1) / count);
    }
    if (stop.stop_requested()) {
        results.stopped = Error{"interrupted"};
    }
    return {};
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
    results.environment = environment_of(frames->context(), options.terrain.threads);
    if (auto flown = fly(*scene, *path, *frames, log, watch, results, stop); !flown) {
        return flown.error();
    }
    results.seconds = watch.seconds();
    if (const auto good = results.raised.report(log, options.view.path); !good) {
        log.note(good.error().message); // the times hold for the flight as it was flown
    }
    results.times = frames->times();
    results.failed_files = session::failed_files(scene->scene);
    results.max_memory =
        std::max({results.max_memory, process_memory().most, results.times.memory_before});
    const auto& stream = scene->terrain->get<scene::TerrainNode>()->stream;
    if (stream != nullptr) {
        results.stream = stream->stats();
    }
    return results;
}

double memory_share(const FlightResults& results) {
    const auto allowed =
        static_cast<double>(results.options.terrain.memory_megabytes) * (1U << 20U);
    return (static_cast<double>(results.max_memory) -
            static_cast<double>(results.times.memory_before)) /
           allowed;
}

} // namespace reljef::bench
