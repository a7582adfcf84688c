#include "bench/suites/scaling.h"

#include <malloc.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/cli/console_log.h"
#include "app/cli/message.h"
#include "bench/runner/benchmark_scene.h"
#include "bench/suites/scaling_terrain.h"
#include "bench/suites/streamed_errors.h"
#include "engine/core/process_memory.h"
#include "engine/core/stopwatch.h"
#include "engine/session/scene_renderer.h"
#include "engine/session/scene_setup.h"
#include "engine/session/streaming.h"

namespace reljef::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::array scaling_poses{scene::Pose::overview, scene::Pose::low};
constexpr int checked_step = 4; // pixels
constexpr int scaling_warm_up = 3;
constexpr int scaling_frames = 20;
constexpr double megabyte = 1024.0 * 1024.0;

// Resets the peak of process_memory() (proc(5), clear_refs).
void reset_peak_memory() {
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << "5";
}

struct ScalingView {
    Stopwatch watch;
    session::Device device;
    session::TerrainScene scene;
};

Result<session::TerrainScene> open_ground(const fs::path& path, const ScalingOptions& options,
                                          const std::stop_token& stop) {
    session::SourceOptions terrain;
    terrain.terrain = path.string();
    terrain.threads = options.suite.threads;
    terrain.memory_megabytes = options.memory_megabytes;
    terrain.placement = terrain::PlacementKind::plane;
    terrain.streamed = true;
    session::Log silent;
    auto source = session::open_terrain(terrain, silent, stop);
    if (!source) {
        return source.error();
    }
    session::SceneOptions view;
    view.pose = scaling_poses.front();
    view.max_error = options.error;
    return session::make_scene(std::move(*source), terrain, view, silent, stop);
}

Result<ScalingView> open_view(const fs::path& path, const ScalingOptions& options,
                              const std::stop_token& stop) {
    const Stopwatch watch;
    auto device = make_device(options.suite);
    if (!device) {
        return device.error();
    }
    auto scene = open_ground(path, options, stop);
    if (!scene) {
        return scene.error();
    }
    return ScalingView{watch, std::move(*device), std::move(*scene)};
}

class ScalingRun {
public:
    ScalingRun(ScalingResults& results, std::stop_token stop)
        : results_(results), options_(results.options), stop_(std::move(stop)) {}

    Result<void> run() {
        const std::vector<int>& sides = options_.sides;
        const auto folder =
            make_scaling_folder(options_.folder, *std::max_element(sides.begin(), sides.end()));
        if (!folder) {
            return folder.error();
        }
        for (const int side : sides) {
            const fs::path path = folder->path() / fmt::format("ground-{}.tif", side);
            if (auto done = run_side(path, side); !done) {
                return done;
            }
            std::error_code ignored;
            fs::remove(path, ignored);
        }
        return {};
    }

private:
    Result<void> run_side(const fs::path& path, int side) {
        if (auto written = write_scaling_terrain(path, side, options_.suite, stop_); !written) {
            return written;
        }
        reset_peak_memory();
        auto view = open_view(path, options_, stop_);
        if (!view) {
            return view.error();
        }
        results_.environment = environment_of(view->device, options_.suite.threads);
        for (const scene::Pose pose : scaling_poses) {
            if (stop_.stop_requested()) {
                return {};
            }
            ScalingRow row;
            row.side = side;
            row.pose = pose;
            if (auto done = draw(*view, row); !done) {
                return done;
            }
            if (row.frames == 0) {
                return {}; // stopped
            }
            results_.rows.push_back(row);
            if (options_.suite.progress) {
                options_.suite.progress(static_cast<double>(results_.rows.size()) /
                                        static_cast<double>(options_.sides.size() * 2));
            }
        }
        return {};
    }

    // Times the first pose from opening the file, the others from moving the camera.
    Result<void> draw(ScalingView& view, ScalingRow& row) const {
        const Stopwatch since_pose;
        const Stopwatch& watch = row.pose == scaling_poses.front() ? view.watch : since_pose;
        set_pose(view.scene, row.pose);
        const scene::Scene& scene = view.scene.scene;
        session::SceneRenderer& renderer = view.device.renderer();
        row.streamed = view.scene.terrain->get<scene::TerrainNode>()->stream != nullptr;
        session::request_tiles(renderer.select(scene).requests);
        if (auto drawn = renderer.draw_selected(true); !drawn) {
            return drawn.error();
        }
        row.first_picture = watch.seconds();
        cli::ConsoleLog log(options_.suite.quiet);
        session::wait_for_tiles(scene, renderer.size(), renderer.selector(), log, stop_);
        if (auto drawn = renderer.draw_selected(true); !drawn) {
            return drawn.error();
        }
        row.last_picture = watch.seconds();
        return measure(view, row);
    }

    Result<void> measure(ScalingView& view, ScalingRow& row) const {
        std::vector<double> ms;
        for (int i = 0; i < scaling_warm_up + scaling_frames && !stop_.stop_requested(); ++i) {
            const auto stats = view.device.renderer().draw(view.scene.scene, true);
            if (!stats) {
                return stats.error();
            }
            row.tiles = stats->tiles;
            row.triangles = stats->triangles;
            if (i >= scaling_warm_up) {
                ms.push_back(stats->cpu_ms + stats->gpu_ms);
            }
        }
        if (ms.empty()) {
            return {};
        }
        row.frames = ms.size();
        row.ms = summarize(ms);
        row.memory_bytes = process_memory().peak;
        const auto hits = view.device.renderer().draw_hits(view.scene.scene);
        if (!hits) {
            return hits.error();
        }
        const auto found = streamed_errors(view.scene.scene, *hits, checked_step, {0, stop_, {}});
        if (!found) {
            return stop_.stop_requested() ? Result<void>() : found.error();
        }
        const std::vector<double>& errors = *found;
        row.pixels = errors.size();
        if (!errors.empty()) {
            row.worst_px = *std::max_element(errors.begin(), errors.end());
            row.p99_px = summarize(errors).p99;
        }
        return {};
    }

    ScalingResults& results_;
    const ScalingOptions& options_;
    std::stop_token stop_;
};

// The lowest and the highest resolution from one pose; null if absent.
std::array<const ScalingRow*, 2> extremes(const ScalingResults& results, scene::Pose pose) {
    const auto [low, high] =
        std::minmax_element(results.options.sides.begin(), results.options.sides.end());
    std::array<const ScalingRow*, 2> found{};
    for (const ScalingRow& row : results.rows) {
        if (row.pose == pose) {
            found[0] = row.side == *low ? &row : found[0];
            found[1] = row.side == *high ? &row : found[1];
        }
    }
    return found;
}

const char* verdict(bool is_met) {
    return is_met ? "met" : "missed";
}

void add_targets(const ScalingResults& results, FigureTable& table) {
    double frame_ratio = 0.0;
    double first_picture = 0.0;
    std::size_t memory = 0;
    for (const scene::Pose pose : scaling_poses) {
        const auto [low, high] = extremes(results, pose);
        if (low == nullptr || high == nullptr) {
            return;
        }
        frame_ratio = std::max(frame_ratio, high->ms.median / low->ms.median);
        first_picture = std::max(first_picture, high->first_picture);
        memory = std::max(memory, high->memory_bytes);
    }
    const int budget = results.options.memory_megabytes;
    const bool fits = memory <= static_cast<std::size_t>(budget) << 20U;
    table.notes.push_back(fmt::format(
        "Highest resolution over lowest: {:.2f} times the frame time (at most {}: {}); first "
        "picture after {:.2f} s (at most {}: {}); {:.0f} MiB (at most {}: {}).",
        frame_ratio, max_frame_ratio, verdict(frame_ratio <= max_frame_ratio), first_picture,
        max_first_picture, verdict(first_picture <= max_first_picture),
        static_cast<double>(memory) / megabyte, budget, verdict(fits)));
    table.summary = {{"frame_ratio", frame_ratio},
                     {"first_picture_s", first_picture},
                     {"memory_bytes", memory},
                     {"met",
                      {{"frame_ratio", frame_ratio <= max_frame_ratio},
                       {"first_picture_s", first_picture <= max_first_picture},
                       {"memory_bytes", fits}}}};
}

} // namespace

ScalingResults run_scaling(const ScalingOptions& options, const std::stop_token& stop) {
    ScalingResults results{.options = options};
    const auto done = ScalingRun(results, stop).run();
    results.end = run_end(done, stop, !results.rows.empty());
    return results;
}

FigureTable figure_table(const ScalingResults& results) {
    using namespace columns;
    const ScalingOptions& options = results.options;
    FigureTable table{
        .suite = "lod-growth",
        .environment = results.environment,
        .shard = {},
        .settings = {{"size", size_text(options.suite.size)},
                     {"max_error", options.error},
                     {"memory_mb", options.memory_megabytes}},
        .summary = {},
        .columns = {name("/side", "side"), name("/pose", "pose"), plain("/streamed", "streamed"),
                    less("/first_picture_s", "first picture", "s"),
                    less("/last_picture_s", "last picture", "s"),
                    detail(plain("/frames", "frames")), less("/ms/median", "median", "ms"),
                    detail(plain("/ms/p95", "p95", "ms")), plain("/ms/p99", "p99", "ms"),
                    plain("/tiles", "tiles"), less("/triangles", "triangles"),
                    less("/memory_bytes", "memory", "bytes", 0),
                    detail(plain("/pixels", "checked pixels")), less("/worst_px", "worst", "px", 3),
                    less("/p99_px", "p99", "px", 3)}};
    table.end = results.end;
    for (const ScalingRow& row : results.rows) {
        table.rows.push_back({row.side, scene::to_string(row.pose), row.streamed, row.first_picture,
                              row.last_picture, row.frames, row.ms.median, row.ms.p95, row.ms.p99,
                              row.tiles, row.triangles, row.memory_bytes, row.pixels, row.worst_px,
                              row.p99_px});
    }
    add_targets(results, table);
    return table;
}

} // namespace reljef::bench
