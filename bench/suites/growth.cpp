#include "bench/suites/growth.h"

#include <malloc.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/cli/console_log.h"
#include "bench/runner/suite_device.h"
#include "bench/suites/growth_ground.h"
#include "engine/core/stopwatch.h"
#include "engine/scene/tile_stream.h"
#include "engine/session/device.h"
#include "engine/session/scene_setup.h"
#include "engine/session/streaming.h"
#include "engine/truth/geometric_error.h"

namespace reljef::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::array growth_poses{scene::Pose::overview, scene::Pose::low};
constexpr int judged_step = 4; // pixels
constexpr int growth_warm_up = 3;
constexpr int growth_frames = 20;

// Of the process, bytes; what a file of /proc says in kB after `name`.
std::size_t max_memory() {
    std::ifstream status("/proc/self/status");
    std::string word;
    while (status >> word) {
        std::size_t kilobytes = 0;
        if (word == "VmHWM:" && status >> kilobytes) {
            return 1024 * kilobytes;
        }
    }
    return 0;
}

// From here on (proc(5), clear_refs), without what was freed before.
void restart_most_memory() {
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << "5";
}

// What is looked at, from its opening on.
struct GrowthStage {
    Stopwatch watch;
    session::Device device;
    session::TerrainScene scene;
};

Result<session::TerrainScene> open_ground(const fs::path& path, const GrowthOptions& options,
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
    view.pose = growth_poses.front();
    view.max_error = options.error;
    return session::make_scene(std::move(*source), terrain, view, silent, stop);
}

Result<GrowthStage> open_stage(const fs::path& path, const GrowthOptions& options,
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
    return GrowthStage{watch, std::move(*device), std::move(*scene)};
}

void set_pose(session::TerrainScene& scene, scene::Pose pose) {
    scene::Camera& camera = *scene.camera->get<scene::Camera>();
    const double near = camera.near;
    camera = scene::pose_camera(pose, scene.bounds,
                                [&](double x, double y) { return scene.ground(x, y); });
    camera.near = near;
}

// The hits' samples are those of the raster, whose heights are known wherever they lie.
class GrowthJudge {
public:
    GrowthJudge(const GrowthStage& stage, glm::ivec2 size, int side)
        : node_(*stage.scene.terrain->get<scene::TerrainNode>()),
          camera_(stage.scene.scene.camera()), size_(size), side_(side) {}

    [[nodiscard]] std::vector<double> errors(const HitBuffer& hits) const {
        std::vector<double> errors;
        for (int y = 0; y < size_.y; y += judged_step) {
            for (int x = 0; x < size_.x; x += judged_step) {
                if (truth::shows_terrain(hits(x, y))) {
                    errors.push_back(error({x, y}, hits(x, y)));
                }
            }
        }
        return errors;
    }

private:
    [[nodiscard]] double error(glm::ivec2 pixel, const Hit& hit) const {
        const glm::dvec2 sample(hit.col, hit.row);
        const glm::dvec2 placed =
            node_.stream != nullptr ? node_.stream->maker().on_overview(sample) : sample;
        const scene::Projected shown = scene::project(
            camera_, size_,
            node_.surface->placement().world_from_sample({placed, height_at(sample)}));
        return glm::distance(shown.pixel, glm::dvec2(pixel) + 0.5);
    }

    [[nodiscard]] double height_at(glm::dvec2 sample) const {
        const glm::dvec2 inside = glm::clamp(sample, 0.0, side_ - 1.0);
        const glm::ivec2 first = glm::min(glm::ivec2(inside), side_ - 2);
        const glm::dvec2 part = inside - glm::dvec2(first);
        const auto at = [&](int col, int row) {
            return growth_height(first + glm::ivec2(col, row), side_);
        };
        return glm::mix(glm::mix(at(0, 0), at(1, 0), part.x), glm::mix(at(0, 1), at(1, 1), part.x),
                        part.y);
    }

    const scene::TerrainNode& node_;
    scene::Camera camera_;
    glm::ivec2 size_;
    int side_;
};

class GrowthRun {
public:
    GrowthRun(const GrowthOptions& options, std::stop_token stop)
        : options_(options), stop_(std::move(stop)) {
        results_.options = options;
    }

    Result<void> run() {
        const std::vector<int>& sides = options_.sides;
        const auto folder = GrowthFolder::create(
            options_.folder, sides.empty() ? 0 : *std::max_element(sides.begin(), sides.end()));
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

    GrowthResults take() { return std::move(results_); }

private:
    Result<void> run_side(const fs::path& path, int side) {
        if (auto written = write_growth_ground(path, side, options_.suite, stop_); !written) {
            return written;
        }
        restart_most_memory();
        auto stage = open_stage(path, options_, stop_);
        if (!stage) {
            return stage.error();
        }
        results_.environment = environment_of(stage->device.context(), options_.suite.threads);
        for (const scene::Pose pose : growth_poses) {
            if (stop_.stop_requested()) {
                return {};
            }
            GrowthRow row;
            row.side = side;
            row.pose = pose;
            if (auto done = look(*stage, row); !done) {
                return done;
            }
            if (row.frames == 0) {
                return {}; // stopped before
            }
            results_.rows.push_back(row);
            if (options_.suite.progress) {
                options_.suite.progress(static_cast<double>(results_.rows.size()) /
                                        static_cast<double>(options_.sides.size() * 2));
            }
        }
        return {};
    }

    // A view that is opened begins with the first pose, and flies to the others.
    Result<void> look(GrowthStage& stage, GrowthRow& row) const {
        const Stopwatch since_pose;
        const Stopwatch& watch = row.pose == growth_poses.front() ? stage.watch : since_pose;
        set_pose(stage.scene, row.pose);
        const scene::Scene& scene = stage.scene.scene;
        session::SceneRenderer& renderer = stage.device.renderer();
        row.streamed = stage.scene.terrain->get<scene::TerrainNode>()->stream != nullptr;
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
        return measure(stage, row);
    }

    Result<void> measure(GrowthStage& stage, GrowthRow& row) const {
        std::vector<double> ms;
        for (int i = 0; i < growth_warm_up + growth_frames && !stop_.stop_requested(); ++i) {
            const auto stats = stage.device.renderer().draw(stage.scene.scene, true);
            if (!stats) {
                return stats.error();
            }
            row.tiles = stats->tiles;
            row.triangles = stats->triangles;
            if (i >= growth_warm_up) {
                ms.push_back(stats->cpu_ms + stats->gpu_ms);
            }
        }
        if (ms.empty()) {
            return {};
        }
        row.frames = ms.size();
        row.ms = summarize(ms);
        row.memory_bytes = max_memory();
        const auto hits = stage.device.renderer().draw_hits(stage.scene.scene);
        if (!hits) {
            return hits.error();
        }
        const GrowthJudge judge(stage, options_.suite.size, row.side);
        const std::vector<double> errors = judge.errors(*hits);
        row.pixels = errors.size();
        if (!errors.empty()) {
            row.worst_px = *std::max_element(errors.begin(), errors.end());
            row.p99_px = summarize(errors).p99;
        }
        return {};
    }

    const GrowthOptions& options_;
    std::stop_token stop_;
    GrowthResults results_;
};

} // namespace

std::optional<GrowthMarks> marks_of(const GrowthResults& results) {
    const auto [fewest, most] =
        std::minmax_element(results.options.sides.begin(), results.options.sides.end());
    if (fewest == results.options.sides.end()) {
        return std::nullopt;
    }
    GrowthMarks marks;
    for (const scene::Pose pose : growth_poses) {
        const auto row_of = [&](int side) {
            return std::find_if(
                results.rows.begin(), results.rows.end(),
                [&](const GrowthRow& row) { return row.side == side && row.pose == pose; });
        };
        const auto few = row_of(*fewest);
        const auto many = row_of(*most);
        if (few == results.rows.end() || many == results.rows.end()) {
            return std::nullopt;
        }
        marks.frame_ratio = std::max(marks.frame_ratio, many->ms.median / few->ms.median);
        marks.first_picture = std::max(marks.first_picture, many->first_picture);
        marks.memory_bytes = std::max(marks.memory_bytes, many->memory_bytes);
    }
    return marks;
}

MetMarks met_marks(const GrowthMarks& marks, const GrowthOptions& options) {
    constexpr std::size_t megabyte = 1024U * 1024U;
    return {.frame_ratio = marks.frame_ratio <= max_frame_ratio,
            .first_picture = marks.first_picture <= max_first_picture,
            .memory = marks.memory_bytes <=
                      megabyte * static_cast<std::size_t>(options.memory_megabytes)};
}

GrowthResults run_growth(const GrowthOptions& options, const std::stop_token& stop) {
    GrowthRun run(options, stop);
    const auto done = run.run();
    GrowthResults results = run.take();
    if (stop.stop_requested()) {
        results.stopped = Error{results.rows.empty()
                                    ? "interrupted before the first view was measured"
                                    : "interrupted, the table holds the views measured until then"};
    } else if (!done) {
        results.stopped = done.error();
        results.failed = true;
    }
    return results;
}

} // namespace reljef::bench
