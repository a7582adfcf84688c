#include "bench/suites/error_bound.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <fmt/format.h>

#include "app/cli/message.h"
#include "app/cli/progress_line.h"
#include "bench/runner/benchmark_scene.h"
#include "engine/scene/motion/camera_path.h"
#include "engine/truth/geometric_error.h"

namespace reljef::bench {
namespace {

constexpr int random_step = 4;      // pixels between the checked ones of a random pose
constexpr int flight_frames = 60;   // per path
constexpr double flight_time = 3.0; // seconds of a path from its middle: 20 frames a second

constexpr double beyond = 0.2;     // of the width, outside the terrain
constexpr double min_above = 0.02; // of the width, × e^-1 … e^3
constexpr double usual_fov = 57.3; // degrees

// Portable, unlike the standard library's distributions.
double between(std::mt19937& random, double low, double high) {
    return low +
           (high - low) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
}

// In or beside the terrain, 0.0074 to 0.4 widths above the ground, towards a point of the terrain;
// every third view has a field of view of 10 to 120 degrees.
scene::Camera random_view(std::mt19937& random, const scene::TerrainSurface& surface, double near) {
    const Box& bounds = surface.bounds();
    const glm::dvec3 size = bounds.size();
    scene::Camera camera;
    const double x =
        between(random, bounds.low.x - beyond * size.x, bounds.high.x + beyond * size.x);
    const double y =
        between(random, bounds.low.y - beyond * size.y, bounds.high.y + beyond * size.y);
    const double above = min_above * size.x * std::exp(between(random, -1.0, 3.0));
    camera.eye = {x, y, surface.height_at(x, y).value_or(bounds.high.z) + above};
    camera.target.x = between(random, bounds.low.x, bounds.high.x);
    camera.target.y = between(random, bounds.low.y, bounds.high.y);
    camera.target.z = bounds.center().z;
    const double chosen_fov = between(random, 10.0, 120.0);
    camera.vertical_fov = between(random, 0.0, 3.0) < 1.0 ? chosen_fov : usual_fov;
    camera.near = near;
    return camera;
}

struct Flight {
    std::string name;
    scene::CameraPath path;
};

// Every step-th pixel of a frame in both directions.
struct PixelLattice {
    glm::ivec2 first{0};
    int step = 1;
};

struct FrameErrors {
    std::size_t pixels = 0;
    std::size_t violations = 0;
    std::size_t holes = 0;
    double worst = 0.0;

    void add(const FrameErrors& other) {
        pixels += other.pixels;
        violations += other.violations;
        holes += other.holes;
        worst = std::max(worst, other.worst);
    }
};

class FrameChecker {
public:
    FrameChecker(const BenchmarkScene& scene, glm::ivec2 size, double error, unsigned threads)
        : surface_(*scene.terrain().get<scene::TerrainNode>()->surface),
          world_from_local_(scene.terrain().world_from_local()), size_(size), error_(error),
          threads_(threads) {}

    FrameErrors check_frame(const scene::Camera& camera, const HitBuffer& hits,
                            const PixelLattice& lattice) const {
        const int rows = (size_.y - lattice.first.y + lattice.step - 1) / lattice.step;
        std::vector<FrameErrors> parts(static_cast<std::size_t>(rows));
        const truth::SurfaceView view{surface_.heightfield().heights.view(), surface_.placement(),
                                      world_from_local_, camera};
        parallel_for(
            rows,
            [&](int index) {
                const int y = lattice.first.y + index * lattice.step;
                for (int x = lattice.first.x; x < size_.x; x += lattice.step) {
                    check_pixel(view, {x, y}, hits(x, y), parts[static_cast<std::size_t>(index)]);
                }
            },
            {threads_, {}, {}});
        FrameErrors all;
        for (const FrameErrors& part : parts) {
            all.add(part);
        }
        return all;
    }

private:
    void check_pixel(const truth::SurfaceView& view, glm::ivec2 pixel, const Hit& hit,
                     FrameErrors& errors) const {
        if (!truth::shows_terrain(hit)) {
            errors.holes += is_hole(view.camera, pixel) ? 1U : 0U;
            return;
        }
        const double error = truth::reprojection_error(view, size_, pixel, hit);
        ++errors.pixels;
        errors.violations += error <= error_ ? 0 : 1;
        errors.worst = std::max(errors.worst, error);
    }

    // Whether the exact rays around the pixel, farther away than the error bound, all hit terrain,
    // and none of its ends is as near. Otherwise a silhouette may have moved within the bound, or
    // an end that a silhouette just hid.
    [[nodiscard]] bool is_hole(const scene::Camera& camera, glm::ivec2 pixel) const {
        const double reach = error_ + 1.0;
        const glm::dvec2 center = glm::dvec2(pixel) + 0.5;
        for (const int i : {4, 0, 1, 2, 3, 5, 6, 7, 8}) {
            const glm::dvec2 place = center + reach * glm::dvec2(i % 3 - 1, i / 3 - 1);
            if (!surface_.pick(scene::view_ray(camera, size_, place))) {
                return false;
            }
        }
        return distance_to_end(camera, pixel) > reach;
    }

    // Distance of a pixel to the samples at the ends of the terrain, pixels.
    [[nodiscard]] double distance_to_end(const scene::Camera& camera, glm::ivec2 pixel) const {
        const auto& heights = surface_.heightfield().heights;
        const glm::ivec2 last(heights.cols() - 1, heights.rows() - 1);
        double nearest = std::numeric_limits<double>::infinity();
        const auto visit = [&](int col, int row) {
            const glm::dvec3 local =
                surface_.placement().world_from_sample({col, row, heights(col, row)});
            const glm::dvec3 world(world_from_local_ * glm::dvec4(local, 1.0));
            nearest = std::min(nearest, truth::distance_to_pixel(camera, size_, pixel, world));
        };
        for (int col = 0; col <= last.x; ++col) {
            visit(col, 0);
            visit(col, last.y);
        }
        for (int row = 0; row <= last.y; ++row) {
            visit(0, row);
            visit(last.x, row);
        }
        return nearest;
    }

    const scene::TerrainSurface& surface_;
    glm::dmat4 world_from_local_;
    glm::ivec2 size_;
    double error_;
    unsigned threads_;
};

ErrorBoundRow row_of(const BenchmarkScene& scene, std::string views, double error) {
    ErrorBoundRow row;
    row.scene = scene.name();
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
          random_(options_.seed), line_("judging views", options_.suite.quiet) {}

    Result<void> run() {
        auto device = make_device(options_.suite);
        if (!device) {
            return device.error();
        }
        results_.environment = environment_of(device->info(), options_.suite.threads);
        for (std::size_t i = 0; i < options_.terrains.size() && !stop_.stop_requested(); ++i) {
            if (auto done = run_terrain(i, device->renderer()); !done) {
                return done;
            }
        }
        return {};
    }

private:
    Result<void> run_terrain(std::size_t index, session::SceneRenderer& driver) {
        auto scene =
            BenchmarkScene::open(choice_of(options_.terrains[index]), options_.suite, stop_);
        if (!scene) {
            return scene.error();
        }
        set_error(*scene, options_.error);
        const double near = scene->scene().camera().near;
        const scene::TerrainSurface& surface = *scene->terrain().get<scene::TerrainNode>()->surface;
        const auto anywhere = [&] { return random_view(random_, surface, near); };
        const auto near_ground = [&] { return view_near_the_ground(random_, surface); };
        if (auto done =
                run_random(*scene, "random", poses_of(options_.poses, index), anywhere, driver);
            !done) {
            return done;
        }
        if (auto done = run_random(*scene, "near ground", poses_of(options_.near_poses, index),
                                   near_ground, driver);
            !done) {
            return done;
        }
        const Box bounds = scene->terrain().world_bounds();
        const auto ground = [&](double x, double y) {
            return scene->scene().height_at(x, y).value_or(bounds.low.z);
        };
        for (const Flight& flight : {Flight{"orbit", scene::orbit_path(bounds)},
                                     Flight{"flyover", scene::flyover_path(bounds, ground)}}) {
            for (const double error : options_.flight_errors) {
                if (auto done = run_flight(*scene, flight, error, driver); !done) {
                    return done;
                }
            }
        }
        return {};
    }

    static void set_error(BenchmarkScene& scene, double error) {
        scene.set_technique(scene::Technique{scene::Polygons{.error = error}});
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

    [[nodiscard]] FrameChecker checker_of(const BenchmarkScene& scene, double error) const {
        return {scene, options_.suite.size, error, static_cast<unsigned>(options_.suite.threads)};
    }

    Result<void> run_random(BenchmarkScene& scene, std::string views, int poses,
                            const std::function<scene::Camera()>& view,
                            session::SceneRenderer& driver) {
        ErrorBoundRow row = row_of(scene, std::move(views), options_.error);
        const FrameChecker checker = checker_of(scene, options_.error);
        Result<void> done;
        for (int i = 0; i < poses && done && !stop_.stop_requested(); ++i) {
            scene.set_camera(view());
            const PixelLattice lattice{glm::ivec2(i, i / random_step) % random_step, random_step};
            done = draw_and_check(scene, lattice, checker, driver, row);
            report_frame();
        }
        return keep(std::move(row), done);
    }

    Result<void> run_flight(BenchmarkScene& scene, const Flight& flight, double error,
                            session::SceneRenderer& driver) {
        set_error(scene, error);
        ErrorBoundRow row = row_of(scene, flight.name, error);
        const FrameChecker checker = checker_of(scene, error);
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
        auto hits = driver.draw_hits(scene.scene());
        if (!hits) {
            return hits.error();
        }
        const scene::Camera camera = scene.scene().camera();
        add_frame(row, checker.check_frame(camera, *hits, lattice), camera);
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
    std::mt19937 random_;
    cli::ProgressLine line_;
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

scene::Camera view_near_the_ground(std::mt19937& random, const scene::TerrainSurface& surface) {
    const Box& bounds = surface.bounds();
    const glm::dvec3 size = bounds.size();
    const double x = bounds.center().x + between(random, -0.45, 0.45) * size.x;
    const double y = bounds.center().y + between(random, -0.45, 0.45) * size.y;
    const double above = 0.3 * std::pow(10.0, between(random, 0.0, 1.0));
    const glm::dvec3 eye(x, y, surface.height_at(x, y).value_or(bounds.high.z) + above);
    const double heading = between(random, 0.0, 360.0);
    scene::Camera camera = scene::camera_from_angles(eye, heading, between(random, -30.0, 5.0));
    camera.near = 1e-3 * above; // cuts no ground away, unless it rises by 700 m per metre
    return camera;
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
    return results;
}

FigureTable figure_table(const ErrorBoundResults& results) {
    const ErrorBoundOptions& options = results.options;
    const std::string size = size_text(options.suite.size);
    FigureTable table{.schema = "reljef-bench-promise/1",
                      .heading = fmt::format("--max-error {}, {}, {}, {} threads", options.error,
                                             size, cli::printable(results.environment.renderer),
                                             results.environment.threads),
                      .settings = {{"environment", json_of(results.environment)},
                                   {"size", size},
                                   {"max_error", options.error},
                                   {"poses", options.poses},
                                   {"seed", options.seed}},
                      .columns = {{"/scene", "scene"},
                                  {"/views", "views"},
                                  {"/max_error", "px"},
                                  {"/frames", "frames"},
                                  {"/pixels", "pixels"},
                                  {"/violations", "violations"},
                                  {"/holes", "holes"},
                                  {"/worst_px", "worst px", 4},
                                  {"/worst_view", ""},
                                  {"/triangles", "triangles", 0},
                                  {"/ms/median", "ms"},
                                  {"/ms/p95", ""},
                                  {"/ms/p99", "p99 ms"}},
                      .end = results.end};
    for (const ErrorBoundRow& row : results.rows) {
        const auto& ms = row.ms;
        table.rows.push_back({row.scene, row.views, row.error, row.frames, row.pixels,
                              row.violations, row.holes, row.worst_px, worst_view(row),
                              row.triangles ? FigureJson(*row.triangles) : FigureJson(),
                              ms ? FigureJson(ms->median) : FigureJson(),
                              ms ? FigureJson(ms->p95) : FigureJson(),
                              ms ? FigureJson(ms->p99) : FigureJson()});
    }
    if (!results.within_bound()) {
        table.summary = "pixels over the bound, or holes, found; none were expected\n";
    }
    return table;
}

} // namespace reljef::bench
