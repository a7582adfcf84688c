#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/render/driver.h"
#include "engine/session/scene_renderer.h"
#include "engine/terrain/field/surface_caster.h"
#include "engine/truth/geometric_error.h"
#include "tests/render/made_scene.h"
#include "tests/support/test_data.h"
#include "tests/terrain/chance.h"

// The promise of an error bound, held against the definition of the error itself.

namespace reljef::truth {

constexpr glm::ivec2 picture{160, 120};

struct Promise {
    int pixels = 0;
    int violations = 0;
    int holes = 0;
    double worst = 0.0;   ///< share of the error that was asked for, or stated if that is larger
    double stated = 1.0;  ///< the largest stated error, as a share of that asked for
    int as_triangles = 0; ///< pictures
    int by_rays = 0;
    int by_both = 0;

    void add(const std::optional<view::Choice>& choice) {
        if (choice) {
            const bool rays = choice->tiles_by_rays > 0;
            const bool triangles = choice->tiles_as_triangles > 0;
            by_both += rays && triangles ? 1 : 0;
            by_rays += rays && !triangles ? 1 : 0;
            as_triangles += !rays && triangles ? 1 : 0;
        }
    }
};

// A hole shows no terrain though the exact rays around it all meet some: farther from a silhouette
// than the error that is allowed.
inline bool is_hole(const terrain::SurfaceCaster& surface, const scene::Camera& camera,
                    glm::dvec2 center, double error) {
    const double reach = error + 1.0;
    for (int i = 0; i < 9; ++i) {
        const glm::dvec2 place = center + reach * glm::dvec2(i % 3 - 1, i / 3 - 1);
        if (!surface.first_hit(scene::view_ray(camera, picture, place))) {
            return false;
        }
    }
    return true;
}

inline void judge(const scene::Scene& scene, const scene::Node& node, const HitBuffer& hits,
                  double error, Promise& promise) {
    const auto& surface = test::surface_of(node);
    const SurfaceView view{surface.heightfield().heights.view(), surface.placement(),
                           node.world_from_local(), scene.camera()};
    const terrain::SurfaceCaster exact(view.heights, surface.pyramid(), surface.placement());
    for (int y = 0; y < picture.y; ++y) {
        for (int x = 0; x < picture.x; ++x) {
            const Hit& hit = hits(x, y);
            if (!shows_terrain(hit)) {
                const bool is_sampled = (x * 7 + y * 13) % 23 == 0;
                promise.holes +=
                    is_sampled && is_hole(exact, scene.camera(), {x + 0.5, y + 0.5}, error) ? 1 : 0;
                continue;
            }
            const double found = reprojection_error(view, picture, {x, y}, hit);
            ++promise.pixels;
            promise.violations += found > error ? 1 : 0;
            promise.worst = std::max(promise.worst, found / error);
        }
    }
}

inline scene::Camera chance_camera(test::Chance& chance, const scene::TerrainSurface& surface) {
    const Box& bounds = surface.bounds();
    const glm::dvec3 size = bounds.size();
    scene::Camera camera;
    const double x = chance.between(bounds.low.x - 0.2 * size.x, bounds.high.x + 0.2 * size.x);
    const double y = chance.between(bounds.low.y - 0.2 * size.y, bounds.high.y + 0.2 * size.y);
    const double above = 0.02 * size.x * std::exp(chance.between(-1.0, 3.0));
    camera.eye = {x, y, surface.height_at(x, y).value_or(bounds.high.z) + above};
    camera.target = {chance.between(bounds.low.x, bounds.high.x),
                     chance.between(bounds.low.y, bounds.high.y), bounds.center().z};
    camera.vertical_fov = chance.one_in(3) ? chance.between(10.0, 120.0) : 57.3;
    camera.near = 1e-5 * size.x;
    return camera;
}

// 0.3 to 3 m above the ground, heading anywhere, pitched -30 to 5 degrees.
inline scene::Camera camera_near_the_ground(test::Chance& chance,
                                            const scene::TerrainSurface& surface) {
    const Grid<float>& heights = surface.heightfield().heights;
    const glm::dvec2 sample(chance.between(0.0, heights.cols() - 1.0),
                            chance.between(0.0, heights.rows() - 1.0));
    const glm::dvec3 ground = surface.placement().world_from_sample(
        {sample, terrain::bilinear_height(heights.view(), sample)});
    const glm::dvec3 up = surface.placement().up(ground);
    const double above = 0.3 * std::pow(10.0, chance.between(0.0, 1.0));
    scene::Camera camera = scene::camera_from_angles(
        ground + above * up, chance.between(0.0, 360.0), chance.between(-30.0, 5.0),
        {up, surface.placement().north(ground)});
    camera.near = 1e-3 * above;
    return camera;
}

// A telescope, or the same without perspective: a field of view of 0.001 to 1 degree.
inline scene::Camera narrow_camera_at(test::Chance& chance, const scene::TerrainSurface& surface,
                                      double widths) {
    const glm::dvec3 middle = surface.bounds().center();
    const double distance = surface.bounds().size().x * widths;
    const glm::dvec3 away(chance.between(-1.0, 1.0), chance.between(-1.0, 1.0),
                          chance.between(0.02, 1.0));
    scene::Camera camera;
    camera.eye = middle + distance * glm::normalize(away);
    camera.target = middle;
    camera.vertical_fov = std::pow(10.0, chance.between(-3.0, 0.0));
    camera.view_height = 2.0 * distance * std::tan(0.5 * glm::radians(camera.vertical_fov));
    camera.projection =
        chance.one_in(3) ? scene::ProjectionKind::orthographic : scene::ProjectionKind::perspective;
    return camera;
}

inline scene::Camera narrow_camera(test::Chance& chance, const scene::TerrainSurface& surface) {
    return narrow_camera_at(chance, surface, std::exp(chance.between(-1.0, 8.0)));
}

inline scene::Camera far_narrow_camera(test::Chance& chance, const scene::TerrainSurface& surface) {
    return narrow_camera_at(chance, surface, std::exp(chance.between(4.5, 8.0)));
}

using ChanceCamera = scene::Camera (*)(test::Chance&, const scene::TerrainSurface&);

struct PromiseOptions {
    int poses = 40;
    unsigned seed = 1;
    scene::TerrainOptions terrain = {};
    const char* technique = "polygons:error={}"; ///< with its error
    ChanceCamera any_camera = chance_camera;
    view::TechniqueCosts costs = {};
};

inline Promise promise_over(terrain::Heightfield heightfield, const PromiseOptions& options) {
    test::Chance chance(options.seed);
    scene::Scene scene;
    scene::Node& node = test::add_terrain(scene, std::move(heightfield), {}, options.terrain);
    scene::Node& camera = scene.add_camera();
    session::SceneRenderer driver = test::must(session::SceneRenderer::create(
        {.opengl = render::DriverOptions{.size = picture, .shader_dir = {}, .software = true},
         .costs = options.costs}));
    Promise promise;
    for (int i = 0; i < options.poses; ++i) {
        const double error = std::exp(chance.between(-1.4, 1.4));
        *camera.get<scene::Camera>() = options.any_camera(chance, test::surface_of(node));
        node.get<scene::TerrainNode>()->material.technique =
            scene::parse_technique(fmt::format(fmt::runtime(options.technique), error)).value();
        driver.select(scene);
        const view::DrawnHits drawn = test::must(driver.draw_selected_hits());
        const double stated = std::max(error, drawn.stats.kept_error.value_or(error));
        promise.stated = std::max(promise.stated, stated / error);
        promise.add(drawn.stats.choice);
        judge(scene, node, drawn.hits, stated, promise);
    }
    return promise;
}

inline void expect_kept(const Promise& promise) {
    EXPECT_GT(promise.pixels, 20000);
    EXPECT_EQ(promise.violations, 0) << "worst " << promise.worst << " of the error asked for";
    EXPECT_EQ(promise.holes, 0);
    EXPECT_EQ(promise.stated, 1.0);
}

} // namespace reljef::truth
