#include "bench/suites/promise.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <random>

#include <fmt/format.h>

#include "app/cli/progress_line.h"
#include "bench/runner/random_views.h"
#include "bench/runner/stage.h"
#include "bench/runner/suite_device.h"
#include "engine/scene/motion/animators.h"
#include "engine/scene/motion/camera_path.h"
#include "engine/truth/geometric_error.h"

namespace reljef::bench {
namespace {

constexpr int random_step = 4;      // pixels between those that are judged of a random pose
constexpr int flight_frames = 60;   // of a path
constexpr double flight_time = 3.0; // seconds of the path, from its middle on: 20 frames a second

struct Flight {
    std::string name;
    scene::CameraPath path;
};

// Some pixels of a frame.
struct PixelLattice {
    glm::ivec2 first{0};
    int step = 1;
};

struct FrameJudgement {
    std::size_t pixels = 0;
    std::size_t violations = 0;
    std::size_t holes = 0;
    double worst = 0.0;

    void add(const FrameJudgement& other) {
        pixels += other.pixels;
        violations += other.violations;
        holes += other.holes;
        worst = std::max(worst, other.worst);
    }
};

// Judges frames of one stage.
class Judge {
public:
    Judge(const Stage& stage, glm::ivec2 size, double error, unsigned threads)
        : surface_(*stage.terrain().get<scene::TerrainNode>()->surface),
          world_from_local_(stage.terrain().world_from_local()), size_(size), error_(error),
          threads_(threads) {}

    FrameJudgement judge(const scene::Camera& camera, const HitBuffer& hits,
                         const PixelLattice& lattice) const {
        const int rows = (size_.y - lattice.first.y + lattice.step - 1) / lattice.step;
        std::vector<FrameJudgement> parts(static_cast<std::size_t>(rows));
        const truth::SurfaceView view{surface_.heightfield().heights.view(), surface_.placement(),
                                      world_from_local_, camera};
        parallel_for(
            rows,
            [&](int index) {
                const int y = lattice.first.y + index * lattice.step;
                for (int x = lattice.first.x; x < size_.x; x += lattice.step) {
                    judge_pixel(view, {x, y}, hits(x, y), parts[static_cast<std::size_t>(index)]);
                }
            },
            {threads_, {}, {}});
        FrameJudgement all;
        for (const FrameJudgement& part : parts) {
            all.add(part);
        }
        return all;
    }

private:
    void judge_pixel(const truth::SurfaceView& view, glm::ivec2 pixel, const Hit& hit,
                     FrameJudgement& judgement) const {
        if (!truth::shows_terrain(hit)) {
            judgement.holes += is_hole(view.camera, glm::dvec2(pixel) + 0.5) ? 1U : 0U;
            return;
        }
        const double error = truth::reprojection_error(view, size_, pixel, hit);
        ++judgement.pixels;
        judgement.violations += error <= error_ ? 0 : 1;
        judgement.worst = std::max(judgement.worst, error);
    }

    // The exact rays around it, farther away than the error that is allowed, all meet terrain: it
    // is no silhouette that lies a little elsewhere.
    [[nodiscard]] bool is_hole(const scene::Camera& camera, glm::dvec2 center) const {
        const double reach = error_ + 1.0;
        for (const int i : {4, 0, 1, 2, 3, 5, 6, 7, 8}) {
            const glm::dvec2 place = center + reach * glm::dvec2(i % 3 - 1, i / 3 - 1);
            if (!surface_.pick(scene::view_ray(camera, size_, place))) {
                return false;
            }
        }
        return true;
    }

    const scene::TerrainSurface& surface_;
    glm::dmat4 world_from_local_;
    glm::ivec2 size_;
    double error_;
    unsigned threads_;
};

PromiseRow row_of(const Stage& stage, std::string views, double error) {
    PromiseRow row;
    row.scene = stage.name();
    row.error = error;
    row.views = std::move(views);
    return row;
}

void add_frame(PromiseRow& row, const FrameJudgement& frame, const scene::Camera& camera) {
    ++row.frames;
    row.pixels += frame.pixels;
    row.violations += frame.violations;
    row.holes += frame.holes;
    if (!row.worst || frame.worst > row.worst_px) {
        row.worst_px = frame.worst;
        row.worst = camera;
    }
}

class PromiseRun {
public:
    PromiseRun(const PromiseOptions& options, std::stop_token stop)
        : options_(options), stop_(std::move(stop)), random_(options.seed),
          line_("judging views", options.suite.quiet) {
        results_.options = options;
    }

    Result<void> run() {
        auto device = make_device(options_.suite);
        if (!device) {
            return device.error();
        }
        results_.environment = environment_of(device->context(), options_.suite.threads);
        for (std::size_t i = 0; i < options_.terrains.size() && !stop_.stop_requested(); ++i) {
            if (auto done = run_terrain(i, device->renderer()); !done) {
                return done;
            }
        }
        return {};
    }

    PromiseResults take() { return std::move(results_); }

private:
    Result<void> run_terrain(std::size_t index, session::SceneRenderer& driver) {
        const SuiteOptions& suite = options_.suite;
        auto stage = Stage::open({.terrain = options_.terrains[index]},
                                 {suite.size, suite.threads, suite.quiet}, stop_);
        if (!stage) {
            return stage.error();
        }
        set_error(*stage, options_.error);
        if (auto done = run_random(*stage, poses_of(index), driver); !done) {
            return done;
        }
        const Box bounds = stage->terrain().world_bounds();
        const auto ground = [&](double x, double y) {
            return stage->scene().height_at(x, y).value_or(bounds.low.z);
        };
        for (const Flight& flight : {Flight{"orbit", scene::orbit_path(bounds)},
                                     Flight{"flyover", scene::flyover_path(bounds, ground)}}) {
            for (const double error : flight_errors()) {
                if (auto done = run_flight(*stage, flight, error, driver); !done) {
                    return done;
                }
            }
        }
        return {};
    }

    static void set_error(Stage& stage, double error) {
        stage.set_technique(scene::Technique{scene::Polygons{.error = error}});
    }

    [[nodiscard]] std::vector<double> flight_errors() const {
        return options_.flight_errors.empty() ? std::vector{options_.error}
                                              : options_.flight_errors;
    }

    // The terrain's share of all.
    [[nodiscard]] int poses_of(std::size_t index) const {
        const auto count = static_cast<int>(options_.terrains.size());
        return options_.poses / count + (static_cast<int>(index) < options_.poses % count ? 1 : 0);
    }

    [[nodiscard]] Judge judge_of(const Stage& stage, double error) const {
        return {stage, options_.suite.size, error, static_cast<unsigned>(options_.suite.threads)};
    }

    Result<void> run_random(Stage& stage, int poses, session::SceneRenderer& driver) {
        PromiseRow row = row_of(stage, "random", options_.error);
        const Judge judge = judge_of(stage, options_.error);
        const scene::TerrainSurface& surface = *stage.terrain().get<scene::TerrainNode>()->surface;
        const double near = stage.scene().camera().near;
        Result<void> done;
        for (int i = 0; i < poses && done && !stop_.stop_requested(); ++i) {
            stage.set_camera(random_view(random_, surface, near));
            const PixelLattice lattice{glm::ivec2(i, i / random_step) % random_step, random_step};
            done = judge_frame(stage, lattice, judge, driver, row);
            tell_frame();
        }
        return keep(std::move(row), done);
    }

    Result<void> run_flight(Stage& stage, const Flight& flight, double error,
                            session::SceneRenderer& driver) {
        set_error(stage, error);
        PromiseRow row = row_of(stage, flight.name, error);
        const Judge judge = judge_of(stage, error);
        const scene::Camera camera = stage.scene().camera();
        const double begin = flight.path.begin() + 0.5 * flight.path.duration();
        std::vector<double> ms;
        double triangles = 0.0;
        Result<void> done;
        for (int i = 0; i < flight_frames && done && !stop_.stop_requested(); ++i) {
            const double time = begin + flight_time * i / (flight_frames - 1.0);
            stage.set_camera(scene::at_key(camera, flight.path.at(time)));
            const auto stats = driver.draw(stage.scene(), true);
            if (!stats) {
                return stats.error();
            }
            ms.push_back(stats->cpu_ms + stats->gpu_ms);
            triangles += static_cast<double>(stats->triangles);
            done = judge_frame(stage, {}, judge, driver, row);
            tell_frame();
        }
        if (row.frames > 0) {
            row.triangles = triangles / static_cast<double>(row.frames);
            row.ms = summarize(ms);
        }
        return keep(std::move(row), done);
    }

    Result<void> judge_frame(const Stage& stage, const PixelLattice& lattice, const Judge& judge,
                             session::SceneRenderer& driver, PromiseRow& row) {
        auto hits = driver.draw_hits(stage.scene());
        if (!hits) {
            return hits.error();
        }
        const scene::Camera camera = stage.scene().camera();
        add_frame(row, judge.judge(camera, *hits, lattice), camera);
        return {};
    }

    Result<void> keep(PromiseRow row, Result<void> done) {
        if (row.frames > 0) {
            results_.rows.push_back(std::move(row));
        }
        return done;
    }

    void tell_frame() {
        const double frames = options_.poses + 2.0 * flight_frames *
                                                   static_cast<double>(options_.terrains.size() *
                                                                       flight_errors().size());
        const double fraction = ++frames_ / frames;
        line_.update(fraction);
        if (options_.suite.progress) {
            options_.suite.progress(fraction);
        }
    }

    const PromiseOptions& options_;
    std::stop_token stop_;
    std::mt19937 random_;
    cli::ProgressLine line_;
    double frames_ = 0.0;
    PromiseResults results_;
};

} // namespace

bool PromiseResults::kept() const {
    return std::all_of(rows.begin(), rows.end(),
                       [](const PromiseRow& row) { return row.violations == 0 && row.holes == 0; });
}

PromiseResults run_promise(const PromiseOptions& options, const std::stop_token& stop) {
    PromiseRun run(options, stop);
    const auto done = run.run();
    PromiseResults results = run.take();
    if (stop.stop_requested()) {
        results.stopped = Error{results.rows.empty()
                                    ? "interrupted before the first view was judged"
                                    : "interrupted, the table holds the views judged until then"};
    } else if (!done) {
        results.stopped = done.error();
        results.failed = true;
    }
    return results;
}

} // namespace reljef::bench
