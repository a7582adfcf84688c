#include "bench/suites/error_bound.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <glm/common.hpp>

#include "app/cli/progress_line.h"
#include "bench/runner/benchmark_scene.h"
#include "bench/runner/problems.h"
#include "bench/suites/frame_check.h"
#include "bench/suites/random_views.h"
#include "engine/scene/motion/camera_path.h"

namespace reljef::bench {
namespace {

constexpr int random_step = 4;      // pixels between the checked ones of a random pose
constexpr int flight_frames = 60;   // per path
constexpr double flight_time = 3.0; // seconds of a path from its middle: 20 frames a second

struct Flight {
    std::string name;
    scene::CameraPath path;
};

const scene::TerrainSurface& bounded_surface(const BenchmarkScene& scene) {
    return *scene.terrain().get<scene::TerrainNode>()->surface;
}

ErrorBoundRow row_of(const BenchmarkScene& scene, std::string views, double error) {
    ErrorBoundRow row;
    row.scene = scene.name();
    row.placement = bounded_surface(scene).placement().kind();
    row.error = error;
    row.views = std::move(views);
    return row;
}

void add_frame(ErrorBoundRow& row, const FrameErrors& frame, const scene::Camera& camera) {
    ++row.frames;
    row.pixels += frame.pixels;
    row.violations += frame.violations;
    row.holes += frame.holes;
    if (!row.worst || frame.worst > row.worst_px) {
        row.worst_px = frame.worst;
        row.worst = camera;
    }
}

class ErrorBoundRun {
public:
    ErrorBoundRun(ErrorBoundResults& results, std::stop_token stop)
        : results_(results), options_(results.options), stop_(std::move(stop)),
          generators_(options_.seed, options_.skip), line_("judging views", options_.suite.quiet) {}

    Result<void> run() {
        auto device = make_device(options_.suite);
        if (!device) {
            return device.error();
        }
        results_.environment = environment_of(*device, options_.suite.threads);
        for (std::size_t i = 0; i < options_.terrains.size() && !stop_.stop_requested(); ++i) {
            if (auto done = run_terrain(i, device->renderer()); !done && !stop_.stop_requested()) {
                problems_.add(done.error());
            }
        }
        return problems_.end();
    }

private:
    Result<void> run_terrain(std::size_t index, session::SceneRenderer& driver) {
        SceneChoice choice = choice_of(options_.terrains[index]);
        const auto poses = poses_of(options_.poses, index);
        const auto near_poses = poses_of(options_.near_poses, index);
        bool on_earth = false;
        {
            auto scene = BenchmarkScene::open(choice, options_.suite, stop_);
            if (!scene) {
                return scene.error();
            }
            on_earth = bounded_surface(*scene).heightfield().georeference.has_value();
            const int share = on_earth ? 2 : 1;
            auto done = run_views(*scene, poses / share, near_poses / share, driver);
            done = done ? run_flights(*scene, driver) : done;
            if (!done || !on_earth) {
                return done;
            }
        }
        choice.placement = terrain::PlacementKind::ellipsoid;
        auto scene = BenchmarkScene::open(choice, options_.suite, stop_);
        return scene ? run_views(*scene, poses - poses / 2, near_poses - near_poses / 2, driver)
                     : Result<void>(scene.error());
    }

    Result<void> run_views(BenchmarkScene& scene, int poses, int near_poses,
                           session::SceneRenderer& driver) {
        set_error(scene, options_.error);
        auto done = run_random(scene, "random", poses, random_view, driver);
        return done ? run_random(scene, "near ground", near_poses, view_near_the_ground, driver)
                    : done;
    }

    Result<void> run_flights(BenchmarkScene& scene, session::SceneRenderer& driver) {
        const Box bounds = scene.terrain().world_bounds();
        const auto ground = [&](double x, double y) {
            return scene.scene().height_at(x, y).value_or(bounds.low.z);
        };
        for (const Flight& flight : {Flight{"orbit", scene::orbit_path(bounds)},
                                     Flight{"flyover", scene::flyover_path(bounds, ground)}}) {
            for (const double error : options_.flight_errors) {
                if (auto done = run_flight(scene, flight, error, driver); !done) {
                    return done;
                }
            }
        }
        return {};
    }

    void set_error(BenchmarkScene& scene, double error) const {
        scene.set_technique(options_.automatic ? scene::Technique{scene::Automatic{.error = error}}
                                               : scene::Technique{scene::Polygons{.error = error}});
    }

    [[nodiscard]] SceneChoice choice_of(const std::string& terrain) const {
        const bool is_built_in = terrain == "natural" || terrain == "urban";
        return {.terrain = terrain, .size = is_built_in ? options_.built_in_size : 0};
    }

    // The share of a terrain in all poses.
    [[nodiscard]] int poses_of(int poses, std::size_t index) const {
        const auto count = static_cast<int>(options_.terrains.size());
        return poses / count + (static_cast<int>(index) < poses % count ? 1 : 0);
    }

    [[nodiscard]] FrameChecker checker_of(const BenchmarkScene& scene) const {
        return {bounded_surface(scene),
                scene.terrain().world_from_local(),
                options_.suite.size,
                {static_cast<unsigned>(options_.suite.threads), stop_, {}}};
    }

    Result<void> run_random(BenchmarkScene& scene, std::string views, int poses,
                            scene::Camera (*view)(std::mt19937&, const scene::TerrainSurface&),
                            session::SceneRenderer& driver) {
        ErrorBoundRow row = row_of(scene, std::move(views), options_.error);
        const FrameChecker checker = checker_of(scene);
        Result<void> done;
        for (int i = 0; i < poses && done && !stop_.stop_requested(); ++i) {
            if (auto random = generators_.next()) {
                scene.set_camera(view(*random, bounded_surface(scene)));
                const PixelLattice lattice{glm::ivec2(i, i / random_step) % random_step,
                                           random_step};
                done = draw_and_check(scene, lattice, checker, driver, row);
            }
            report_frame();
        }
        return keep(std::move(row), done);
    }

    Result<void> run_flight(BenchmarkScene& scene, const Flight& flight, double error,
                            session::SceneRenderer& driver) {
        set_error(scene, error);
        ErrorBoundRow row = row_of(scene, flight.name, error);
        const FrameChecker checker = checker_of(scene);
        const scene::Camera camera = scene.scene().camera();
        const double begin = flight.path.begin() + 0.5 * flight.path.duration();
        std::vector<double> ms;
        double triangles = 0.0;
        Result<void> done;
        for (int i = 0; i < flight_frames && done && !stop_.stop_requested(); ++i) {
            const double time = begin + flight_time * i / (flight_frames - 1.0);
            scene.set_camera(scene::at_key(camera, flight.path.at(time)));
            const auto stats = driver.draw(scene.scene(), true);
            if (!stats) {
                return stats.error();
            }
            ms.push_back(stats->cpu_ms + stats->gpu_ms);
            triangles += static_cast<double>(stats->triangles);
            done = draw_and_check(scene, {}, checker, driver, row);
            report_frame();
        }
        if (row.frames > 0) {
            row.triangles = triangles / static_cast<double>(row.frames);
            row.ms = summarize(ms);
        }
        return keep(std::move(row), done);
    }

    Result<void> draw_and_check(const BenchmarkScene& scene, const PixelLattice& lattice,
                                const FrameChecker& checker, session::SceneRenderer& driver,
                                ErrorBoundRow& row) {
        driver.select(scene.scene());
        const auto drawn = driver.draw_selected_hits();
        if (!drawn) {
            return drawn.error();
        }
        const double stated = std::max(row.error, drawn->stats.kept_error.value_or(row.error));
        row.stated_px = std::max(row.stated_px, stated);
        const scene::Camera camera = scene.scene().camera();
        const FrameErrors found = checker.check_frame(camera, drawn->hits, stated, lattice);
        if (!stop_.stop_requested()) { // all of its pixels were checked
            add_frame(row, found, camera);
        }
        return {};
    }

    Result<void> keep(ErrorBoundRow row, Result<void> done) {
        if (row.frames > 0) {
            results_.rows.push_back(std::move(row));
        }
        return done;
    }

    void report_frame() {
        const auto flights =
            2.0 * static_cast<double>(options_.terrains.size() * options_.flight_errors.size());
        const double frames = options_.poses + options_.near_poses + flights * flight_frames;
        const double fraction = ++frames_ / frames;
        line_.update(fraction);
        if (options_.suite.progress) {
            options_.suite.progress(fraction);
        }
    }

    ErrorBoundResults& results_;
    const ErrorBoundOptions& options_;
    std::stop_token stop_;
    ViewGenerators generators_;
    cli::ProgressLine line_;
    Problems problems_;
    double frames_ = 0.0;
};

FigureJson worst_view(const ErrorBoundRow& row) {
    if (!row.worst) {
        return {};
    }
    const scene::Camera& camera = *row.worst;
    return {{"eye", {camera.eye.x, camera.eye.y, camera.eye.z}},
            {"look", {camera.target.x, camera.target.y, camera.target.z}},
            {"fov", camera.vertical_fov}};
}

} // namespace

const char* placement_name(terrain::PlacementKind placement) {
    return placement == terrain::PlacementKind::plane ? "plane" : "ellipsoid";
}

bool ErrorBoundResults::within_bound() const {
    return std::all_of(rows.begin(), rows.end(), [](const ErrorBoundRow& row) {
        return row.violations == 0 && row.holes == 0;
    });
}

ErrorBoundResults run_error_bound(const ErrorBoundOptions& options, const std::stop_token& stop) {
    ErrorBoundResults results{.options = options};
    const auto done = ErrorBoundRun(results, stop).run();
    results.end = run_end(done, stop, !results.rows.empty());
    results.end.failed = results.end.failed && results.rows.empty();
    return results;
}

FigureTable figure_table(const ErrorBoundResults& results) {
    using namespace columns;
    const ErrorBoundOptions& options = results.options;
    FigureColumn bound = name("/max_error", "bound");
    bound.unit = "px";
    FigureTable table{
        .suite = "lod-poses",
        .environment = results.environment,
        .shard = {},
        .settings = {{"size", size_text(options.suite.size)},
                     {"max_error", options.error},
                     {"poses", options.poses},
                     {"seed", options.seed},
                     {"auto", options.automatic}},
        .summary = {},
        .columns = {group("/scene", "scene"), name("/views", "views"),
                    name("/placement", "placement"), bound, plain("/frames", "frames"),
                    plain("/pixels", "pixels"), less("/violations", "violations"),
                    less("/holes", "holes"), less("/stated_px", "stated", "px", 4),
                    less("/worst_px", "worst", "px", 4), detail(plain("/worst_view", "worst view")),
                    less("/triangles", "triangles", "", 0), less("/ms/median", "median", "ms"),
                    detail(less("/ms/p95", "p95", "ms")), less("/ms/p99", "p99", "ms")}};
    table.end = results.end;
    for (const ErrorBoundRow& row : results.rows) {
        const auto& ms = row.ms;
        table.rows.push_back(
            {row.scene, row.views, placement_name(row.placement), row.error, row.frames, row.pixels,
             row.violations, row.holes, row.stated_px, row.worst_px, worst_view(row),
             json_or_null(row.triangles), ms ? FigureJson(ms->median) : FigureJson(),
             ms ? FigureJson(ms->p95) : FigureJson(), ms ? FigureJson(ms->p99) : FigureJson()});
    }
    if (!results.within_bound()) {
        table.notes.emplace_back(
            "Pixels farther off than stated, or holes, found; none were expected.");
    }
    return table;
}

} // namespace reljef::bench
