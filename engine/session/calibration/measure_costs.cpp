#include "engine/session/calibration/measure_costs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <variant>
#include <vector>

#include "engine/core/hit.h"
#include "engine/core/statistics.h"
#include "engine/scene/graph/scene.h"
#include "engine/scene/technique/technique.h"

namespace reljef::session {
namespace {

constexpr int views = 12; // of each kind
// In each, the camera moves on as fast as a flight over the terrain in 20 s, at 25 frames a second.
// The first frame draws all anew and is not measured.
constexpr int frames_a_view = 4;
constexpr double circle = 0.65; // its radius, in widths
constexpr double frame_angle = 1.0 / (20.0 * 25.0) / circle;
constexpr double ns_a_ms = 1e6;

// On a circle around the terrain; heights as shares of its width.
scene::Camera camera_at(const TerrainScene& scene, double angle, double height, double target) {
    const Box& bounds = scene.bounds;
    const double width = bounds.size().x;
    scene::Camera camera = *scene.camera->get<scene::Camera>();
    camera.eye =
        bounds.center() + circle * width * glm::dvec3(std::cos(angle), std::sin(angle), 0.0);
    camera.eye.z = bounds.high.z + height * width;
    camera.target = bounds.center() + glm::dvec3(0.0, 0.0, target * width);
    return camera;
}

struct Kind {
    scene::Technique technique;
    double height = 0.35; // of the eye above the highest ground, in widths
    double target = 0.0;  // above the middle of the terrain, in widths
    FrameCost MeasuredFrames::*result;
    int samples = 1; // of a pixel
};

constexpr std::size_t kind_count = 11;

const std::array<Kind, kind_count>& kinds() {
    static const std::array<Kind, kind_count> all{
        Kind{{scene::Polygons{.error = 16.0}}, 0.35, 60.0, &MeasuredFrames::sky},
        Kind{{scene::Polygons{.error = 16.0}}, 0.35, 0.0, &MeasuredFrames::few},
        Kind{{scene::Polygons{.error = 1.0}}, 0.35, 0.0, &MeasuredFrames::many},
        Kind{{scene::Polygons{.error = 1.0}}, 0.03, 0.0, &MeasuredFrames::flat},
        Kind{{scene::Exact{}}, 0.35, 0.0, &MeasuredFrames::rays},
        Kind{{scene::Exact{}}, 0.35, 0.45, &MeasuredFrames::fewer_pixels},
        Kind{{scene::Interval{.linear_steps = 4}}, 0.35, 0.0, &MeasuredFrames::few_steps},
        Kind{{scene::Interval{.linear_steps = 28}}, 0.35, 0.0, &MeasuredFrames::many_steps},
        Kind{{scene::Polygons{.error = 16.0}}, 0.35, 60.0, &MeasuredFrames::sampled_sky, 4},
        Kind{{scene::Polygons{.error = 16.0}}, 0.35, 0.0, &MeasuredFrames::sampled_few, 4},
        Kind{{scene::Polygons{.error = 1.0}}, 0.35, 0.0, &MeasuredFrames::sampled_many, 4}};
    return all;
}

struct Samples {
    std::vector<double> ms;
    FrameCost mean;
};

// Pixels that show terrain; `of_box`: those whose rays cross the box around it, and so search.
double count_pixels(const TerrainScene& scene, const HitBuffer& hits, bool of_box) {
    const Box bounds = scene.terrain->get<scene::TerrainNode>()->surface->bounds();
    const scene::Camera& camera = scene.scene.camera();
    const glm::ivec2 size(hits.cols(), hits.rows());
    double pixels = 0.0;
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const Ray ray = scene::view_ray(camera, size, {x + 0.5, y + 0.5});
            const bool counts = of_box ? intersect(ray, bounds).has_value() : !hits(x, y).is_sky();
            pixels += counts ? 1.0 : 0.0;
        }
    }
    return pixels;
}

void set_technique(TerrainScene& scene, SceneRenderer& renderer, const Kind& kind) {
    scene.terrain->get<scene::TerrainNode>()->material.technique = kind.technique;
    renderer.set_samples(kind.samples);
}

void place_camera(TerrainScene& scene, const Kind& kind, int view, int frame) {
    const double first_angle = 2.0 * std::numbers::pi * (view + 0.5) / (4.0 * views); // a quarter
    *scene.camera->get<scene::Camera>() =
        camera_at(scene, first_angle + frame * frame_angle, kind.height, kind.target);
}

// Only draws: a graphics processor that waits for counts slows down.
Result<void> time_view(TerrainScene& scene, SceneRenderer& renderer, const Kind& kind, int view,
                       Samples& samples) {
    set_technique(scene, renderer, kind);
    for (int frame = 0; frame < frames_a_view; ++frame) {
        place_camera(scene, kind, view, frame);
        const auto stats = renderer.draw(scene.scene, true);
        if (!stats) {
            return stats.error();
        }
        if (frame > 0) {
            samples.ms.push_back(stats->cpu_ms + stats->gpu_ms);
            samples.mean.triangles +=
                static_cast<double>(stats->triangles) / (views * (frames_a_view - 1.0));
        }
    }
    return {};
}

// The touched pixels that `auto` estimates if triangles draw all of the view.
Result<double> estimate_touched(TerrainScene& scene, SceneRenderer& renderer, double error) {
    scene.terrain->get<scene::TerrainNode>()->material.technique = {
        scene::Automatic{.error = error}};
    const auto stats = renderer.draw(scene.scene, true);
    if (!stats) {
        return stats.error();
    }
    return stats->choice ? stats->choice->touched_pixels : 0.0;
}

// In the last frame of the view.
Result<void> count_view(TerrainScene& scene, SceneRenderer& renderer, const Kind& kind, int view,
                        Samples& samples) {
    set_technique(scene, renderer, kind);
    place_camera(scene, kind, view, frames_a_view - 1);
    const auto hits = renderer.draw_hits(scene.scene);
    if (!hits) {
        return hits.error();
    }
    const bool has_rays = scene::searches_surface(kind.technique.id());
    samples.mean.pixels += count_pixels(scene, *hits, has_rays) / views;
    if (const auto* const polygons = std::get_if<scene::Polygons>(&kind.technique.parameters)) {
        const auto touched = estimate_touched(scene, renderer, polygons->error);
        if (!touched) {
            return touched.error();
        }
        samples.mean.touched_pixels += *touched / views;
    }
    if (kind.technique.id() == scene::TechniqueId::interval) {
        const auto work = renderer.count_work(scene.scene);
        if (!work) {
            return work.error();
        }
        samples.mean.steps += static_cast<double>(view::totals_of(*work).steps) / views;
    }
    return {};
}

// Calls `draw` for each view of each kind, beginning with the view `first`. Fails if stopped.
Result<void> for_views(int first, const std::stop_token& stop, const Progress& progress,
                       const std::function<Result<void>(int view, std::size_t kind)>& draw) {
    for (int view = first; view < views; ++view) {
        for (std::size_t kind = 0; kind < kinds().size(); ++kind) {
            if (auto drawn = draw(view, kind); !drawn) {
                return drawn;
            }
            if (stop.stop_requested()) {
                return Error{"interrupted"};
            }
        }
        if (progress) {
            progress((view - first + 1.0) / (views - first));
        }
    }
    return {};
}

double slope(double ms, double count) {
    return count > 0.0 ? std::max(ms, 0.0) * ns_a_ms / count : 0.0;
}

// Two equations: many triangles from above, and many at a flat angle. What few triangles of the
// same pixels cost is subtracted from both.
Costs costs_of_triangles(const MeasuredFrames& frames) {
    Costs costs;
    costs.frame_ms = frames.sky.ms;
    const auto cost_without_few = [&](const FrameCost& frame) {
        const double pixels = frames.few.pixels > 0.0 ? frame.pixels / frames.few.pixels : 0.0;
        return FrameCost{.ms = frame.ms - frames.sky.ms - pixels * (frames.few.ms - frames.sky.ms),
                         .triangles = frame.triangles - pixels * frames.few.triangles,
                         .touched_pixels =
                             frame.touched_pixels - pixels * frames.few.touched_pixels};
    };
    const FrameCost many = cost_without_few(frames.many);
    const FrameCost flat = cost_without_few(frames.flat);
    const double both = flat.triangles * many.touched_pixels - many.triangles * flat.touched_pixels;
    costs.triangle_ns =
        std::min(slope(flat.ms * many.touched_pixels - many.ms * flat.touched_pixels, both),
                 slope(many.ms, many.triangles));
    costs.touched_pixel_ns =
        slope(many.ms - many.triangles * costs.triangle_ns / ns_a_ms, many.touched_pixels);
    costs.covered_pixel_ns = slope(frames.few.ms - frames.sky.ms -
                                       (frames.few.triangles * costs.triangle_ns +
                                        frames.few.touched_pixels * costs.touched_pixel_ns) /
                                           ns_a_ms,
                                   frames.few.pixels);
    return costs;
}

// What each of the three further samples adds to the same views.
void add_costs_of_samples(const MeasuredFrames& frames, Costs& costs) {
    constexpr double further = 3.0;
    const double sky = (frames.sampled_sky.ms - frames.sky.ms) / further;
    const double few = (frames.sampled_few.ms - frames.few.ms) / further;
    const double many = (frames.sampled_many.ms - frames.many.ms) / further;
    costs.frame_sample_ms = std::max(sky, 0.0);
    costs.touched_sample_ns =
        slope(many - few, frames.many.touched_pixels - frames.few.touched_pixels);
    costs.covered_sample_ns = slope(
        few - costs.frame_sample_ms - frames.few.touched_pixels * costs.touched_sample_ns / ns_a_ms,
        frames.few.pixels);
}

} // namespace

Costs costs_from(const MeasuredFrames& frames) {
    Costs costs = costs_of_triangles(frames);
    add_costs_of_samples(frames, costs);
    costs.ray_pixel_ns = slope(frames.rays.ms - frames.fewer_pixels.ms,
                               frames.rays.pixels - frames.fewer_pixels.pixels);
    costs.rays_ms = std::max(
        frames.rays.ms - frames.sky.ms - frames.rays.pixels * costs.ray_pixel_ns / ns_a_ms, 0.0);
    costs.search_step_ns = slope(frames.many_steps.ms - frames.few_steps.ms,
                                 frames.many_steps.steps - frames.few_steps.steps);
    costs.search_pixel_ns = slope(frames.few_steps.ms - frames.sky.ms - costs.rays_ms -
                                      frames.few_steps.steps * costs.search_step_ns / ns_a_ms,
                                  frames.few_steps.pixels);
    return costs;
}

Result<MeasuredFrames> measure_frames(TerrainScene& scene, SceneRenderer& renderer,
                                      const std::stop_token& stop, const Progress& progress) {
    std::array<Samples, kind_count> samples;
    const auto half = [&progress](double done) {
        return [&progress, done](double share) {
            if (progress) {
                progress(done + 0.5 * share);
            }
        };
    };
    auto drawn = for_views(-1, stop, half(0.0), [&](int view, std::size_t kind) {
        Samples warm_up; // the first view
        return time_view(scene, renderer, kinds().at(kind), std::max(view, 0),
                         view < 0 ? warm_up : samples.at(kind));
    });
    if (drawn) {
        drawn = for_views(0, stop, half(0.5), [&](int view, std::size_t kind) {
            return count_view(scene, renderer, kinds().at(kind), view, samples.at(kind));
        });
    }
    if (!drawn) {
        return drawn.error();
    }
    MeasuredFrames frames;
    for (std::size_t kind = 0; kind < kinds().size(); ++kind) {
        const Samples& measured = samples.at(kind);
        FrameCost& result = frames.*kinds().at(kind).result;
        result = measured.mean;
        result.ms = median(measured.ms);
    }
    return frames;
}

} // namespace reljef::session
