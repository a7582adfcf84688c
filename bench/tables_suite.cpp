#include "bench/tables_suite.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <limits>

#include <fmt/format.h>

#include "app/device.h"
#include "app/progress_line.h"
#include "app/scene_setup.h"
#include "bench/measure.h"

namespace reljef::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double seconds_a_terrain = 20.0;
constexpr int most_rounds = 2000;
constexpr double quick_seconds = 10.0; // of measuring, all terrains together
constexpr int most_quick_rounds = 200;
constexpr double quick_limit = 24.0; // seconds for all of it, opening the terrains included

struct Stage {
    std::string name;
    app::TerrainScene scene;
};

// One technique of a stage; what its last frame drew.
struct Entry {
    scene::Technique technique;
    bool null_row = false;
    render::FrameStats stats{};
};

Result<Stage> open_stage(const std::string& name, const TablesOptions& options,
                         const std::stop_token& stop) {
    app::TerrainChoice terrain;
    terrain.terrain = name;
    terrain.threads = options.threads;
    terrain.quiet = options.quiet;
    auto source = app::open_terrain(terrain, stop);
    if (!source) {
        return source.error();
    }
    app::ViewChoice view;
    view.size = options.size;
    view.pose = scene::Pose::overview;
    std::string title = source->description.name;
    auto scene = app::make_scene(std::move(*source), terrain, view);
    if (!scene) {
        return scene.error();
    }
    return Stage{std::move(title), std::move(*scene)};
}

// All of them, so that a mistake in the last one does not cost the time of measuring the others.
Result<std::vector<Stage>> open_stages(const TablesOptions& options, const std::stop_token& stop) {
    std::vector<Stage> stages;
    for (const std::string& name : options.terrains) {
        auto stage = open_stage(name, options, stop);
        if (!stage) {
            return stage.error();
        }
        if (stop.stop_requested()) {
            return Error{"stopped"};
        }
        stages.push_back(std::move(*stage));
    }
    return stages;
}

Result<app::Device> make_device(const TablesOptions& options) {
    app::DeviceOptions device;
    device.threads = options.threads;
    device.context = options.context;
    device.context_options.size = options.size;
    device.context_options.visible = false;
    device.driver.size = options.size;
    return app::Device::create(device);
}

// Texture first: the others are told in terms of it. Texture again last: the null row.
std::vector<Entry> entries_of(const TablesOptions& options) {
    const scene::Technique texture = scene::make_technique(scene::TechniqueId::texture);
    std::vector<scene::Technique> others = options.techniques;
    if (others.empty()) {
        for (const scene::TechniqueInfo& info : scene::technique_catalogue()) {
            others.push_back(scene::make_technique(info.id));
        }
    }
    std::vector<Entry> entries;
    entries.push_back({texture});
    for (const scene::Technique& technique : others) {
        if (technique.id != texture.id) {
            entries.push_back({technique});
        }
    }
    entries.push_back({texture, true});
    return entries;
}

DrawFrame frame_of(Entry& entry, Stage& stage, render::Driver& driver) {
    return [&]() -> Result<void> {
        stage.scene.terrain->get<scene::TerrainNode>()->material.technique = entry.technique;
        auto stats = driver.draw(stage.scene.scene, true);
        if (!stats) {
            return stats.error();
        }
        if (stats->tiles == 0) {
            return Error{
                fmt::format("{}: no terrain found in the picture, some was expected", stage.name)};
        }
        entry.stats = *stats;
        return {};
    };
}

// For one of `stages_left` terrains, when `seconds_gone` since the run began.
MeasureOptions measure_options(const TablesOptions& options, std::size_t stages_left,
                               double seconds_gone) {
    MeasureOptions measure;
    measure.most_rounds = most_rounds;
    measure.seconds = seconds_a_terrain;
    if (options.quick) {
        measure.warm_up_rounds = 1;
        measure.most_rounds = most_quick_rounds;
        measure.seconds = quick_seconds / static_cast<double>(options.terrains.size());
        measure.most_seconds = (quick_limit - seconds_gone) / static_cast<double>(stages_left);
    }
    if (options.rounds > 0) {
        measure.least_rounds = options.rounds;
        measure.most_rounds = options.rounds;
        measure.seconds = 0.0;
        measure.most_seconds = std::numeric_limits<double>::infinity();
    }
    return measure;
}

// A row for every entry that has a frame.
std::vector<Row> rows_of(const std::vector<Entry>& entries, const Measurement& measurement,
                         const Stage& stage, const TablesOptions& options) {
    std::vector<Row> rows;
    for (std::size_t i = 0; i < entries.size() && !measurement.ms[i].empty(); ++i) {
        Row row;
        row.suite = "tables";
        row.scene = stage.name;
        row.technique = entries[i].technique;
        row.null_row = entries[i].null_row;
        row.size = options.size;
        row.frames = measurement.ms[i].size();
        row.ms = summarize(measurement.ms[i]);
        row.stats = entries[i].stats;
        rows.push_back(std::move(row));
    }
    const bool has_floor = rows.size() == entries.size();
    for (Row& row : rows) {
        row.ratio_to_texture = row.ms.median / rows.front().ms.median;
        if (has_floor) {
            row.noise_floor = relative_distance(rows.front().ms.median, rows.back().ms.median);
        }
    }
    return rows;
}

Result<std::vector<Row>> measure_stage(Stage& stage, render::Driver& driver,
                                       const TablesOptions& options,
                                       const MeasureOptions& measuring) {
    std::vector<Entry> entries = entries_of(options);
    std::vector<DrawFrame> frames;
    frames.reserve(entries.size());
    for (Entry& entry : entries) {
        frames.push_back(frame_of(entry, stage, driver));
    }
    const auto measurement = measure(frames, measuring);
    if (!measurement) {
        return measurement.error();
    }
    return rows_of(entries, *measurement, stage, options);
}

Result<void> measure_stages(std::vector<Stage>& stages, render::Driver& driver,
                            const TablesOptions& options, Clock::time_point begin,
                            const std::stop_token& stop, std::vector<Row>& rows) {
    app::ProgressLine line("measuring", options.quiet);
    for (std::size_t i = 0; i < stages.size() && !stop.stop_requested(); ++i) {
        const double seconds_gone = std::chrono::duration<double>(Clock::now() - begin).count();
        MeasureOptions measuring = measure_options(options, stages.size() - i, seconds_gone);
        measuring.stop = stop;
        measuring.progress = [&, i](double fraction) {
            line.update((static_cast<double>(i) + fraction) / static_cast<double>(stages.size()));
        };
        auto found = measure_stage(stages[i], driver, options, measuring);
        if (!found) {
            return found.error();
        }
        std::move(found->begin(), found->end(), std::back_inserter(rows));
    }
    return {};
}

Result<void> run_stages(const TablesOptions& options, const std::stop_token& stop,
                        Results& results) {
    const auto begin = Clock::now();
    auto device = make_device(options);
    if (!device) {
        return device.error();
    }
    results.environment = environment_of(device->context(), options.threads);
    auto stages = open_stages(options, stop);
    if (!stages) {
        return stages.error();
    }
    return measure_stages(*stages, device->driver(), options, begin, stop, results.rows);
}

} // namespace

Results run_tables(const TablesOptions& options, const std::stop_token& stop) {
    Results results;
    const auto done = run_stages(options, stop, results);
    if (stop.stop_requested()) {
        results.stopped =
            Error{results.rows.empty() ? "interrupted before the first frame was timed"
                                       : "interrupted, the table holds the frames drawn "
                                         "until then"};
    } else if (!done) {
        results.stopped = done.error();
    }
    return results;
}

} // namespace reljef::bench
