#include "bench/suites/flight_suite.h"

#include <algorithm>
#include <chrono>

#include "app/cli/console_log.h"
#include "app/cli/progress_line.h"
#include "engine/core/process_memory.h"
#include "engine/scene/motion/animators.h"
#include "engine/session/scene_setup.h"
#include "engine/session/streaming.h"

namespace reljef::bench {
namespace {

using FlightClock = std::chrono::steady_clock;

double flown_since(FlightClock::time_point start) {
    return std::chrono::duration<double>(FlightClock::now() - start).count();
}

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
    terrain.streamed = session::may_stream(options.view);
    terrain.pictures_streamed = session::may_stream_pictures(options.view);
    auto source = session::open_terrain(terrain, log, stop);
    if (!source) {
        return source.error();
    }
    session::SceneOptions view = options.view;
    if (!view.technique) {
        view.max_error = view.max_error.value_or(0.0); // measured as it is: every sample of a tile
    }
    return session::make_scene(std::move(*source), terrain, view, log, stop);
}

Result<void> fly(session::TerrainScene& scene, const scene::FlyPath& path,
                 session::DeviceFrames& frames, session::Log& log, FlightClock::time_point start,
                 FlightResults& results, const std::stop_token& stop) {
    const int count = results.options.view.frames;
    cli::ProgressLine line("flying", results.options.terrain.quiet);
    for (int index = 0; index < count && !stop.stop_requested(); ++index) {
        static_cast<void>(session::fly_above_ground(scene, path, index, count, frames, stop));
        ParallelOptions parallel;
        parallel.stop = stop;
        if (const auto drawn = frames.draw(scene.scene, parallel); !drawn) {
            return drawn.error();
        }
        results.most_memory = std::max(results.most_memory, process_memory().now);
        session::log_stream_faults(scene.scene, log);
        if (index == 0) {
            results.seconds_to_first_frame = flown_since(start);
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
    const auto start = FlightClock::now();
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
    if (auto flown = fly(*scene, *path, *frames, log, start, results, stop); !flown) {
        return flown.error();
    }
    results.seconds = flown_since(start);
    results.times = frames->times();
    results.faulty_files = session::faulty_files(scene->scene);
    results.most_memory =
        std::max({results.most_memory, process_memory().most, results.times.memory_before});
    const auto& stream = scene->terrain->get<scene::TerrainNode>()->stream;
    if (stream != nullptr) {
        results.stream = stream->stats();
    }
    return results;
}

double memory_share(const FlightResults& results) {
    const auto allowed =
        static_cast<double>(results.options.terrain.memory_megabytes) * (1U << 20U);
    return (static_cast<double>(results.most_memory) -
            static_cast<double>(results.times.memory_before)) /
           allowed;
}

} // namespace reljef::bench
