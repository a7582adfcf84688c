// The promise of polygons:error=PX, held against the definition of the error itself.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/render/driver.h"
#include "engine/truth/draw.h"
#include "engine/truth/geometric_error.h"
#include "tests/gl/gl_fixture.h"
#include "tests/render/made_scene.h"
#include "tests/session/made_session.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"
#include "tests/terrain/chance.h"

namespace reljef::truth {
namespace {

constexpr glm::ivec2 picture{160, 120};
constexpr const char* alps = "natural/srtm3/N45E006.hgt";

class PolygonsErrorGlTest : public test::GlTest {};

struct Promise {
    int pixels = 0;
    int violations = 0;
    int holes = 0;
    double worst = 0.0;  ///< share of the error that was asked for, or stated if that is larger
    double stated = 1.0; ///< the largest stated error, as a share of that asked for
};

// A hole shows no terrain though the exact rays around it all meet some: farther from a silhouette
// than the error that is allowed.
bool is_hole(const scene::TerrainSurface& surface, const scene::Camera& camera, glm::dvec2 center,
             double error) {
    const double reach = error + 1.0;
    for (int i = 0; i < 9; ++i) {
        const glm::dvec2 place = center + reach * glm::dvec2(i % 3 - 1, i / 3 - 1);
        if (!surface.pick(scene::view_ray(camera, picture, place))) {
            return false;
        }
    }
    return true;
}

void judge(const scene::Scene& scene, const scene::Node& node, const HitBuffer& hits, double error,
           Promise& promise) {
    const auto& surface = test::surface_of(node);
    const SurfaceView view{surface.heightfield().heights.view(), surface.placement(),
                           node.world_from_local(), scene.camera()};
    for (int y = 0; y < picture.y; ++y) {
        for (int x = 0; x < picture.x; ++x) {
            const Hit& hit = hits(x, y);
            if (!shows_terrain(hit)) {
                const bool is_sampled = (x * 7 + y * 13) % 23 == 0;
                promise.holes +=
                    is_sampled && is_hole(surface, scene.camera(), {x + 0.5, y + 0.5}, error) ? 1
                                                                                              : 0;
                continue;
            }
            const double found = reprojection_error(view, picture, {x, y}, hit);
            ++promise.pixels;
            promise.violations += found > error ? 1 : 0;
            promise.worst = std::max(promise.worst, found / error);
        }
    }
}

scene::Camera chance_camera(test::Chance& chance, const scene::TerrainSurface& surface) {
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
scene::Camera camera_near_the_ground(test::Chance& chance, const scene::TerrainSurface& surface) {
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

using ChanceCamera = scene::Camera (*)(test::Chance&, const scene::TerrainSurface&);

Promise promise_over(terrain::Heightfield heightfield, int poses, unsigned seed,
                     const scene::TerrainOptions& options = {}, int morph = 0,
                     ChanceCamera any_camera = chance_camera) {
    test::Chance chance(seed);
    scene::Scene scene;
    scene::Node& node = test::add_terrain(scene, std::move(heightfield), {}, options);
    scene::Node& camera = scene.add_camera();
    session::SceneRenderer driver = test::must(test::make_renderer(picture));
    Promise promise;
    for (int i = 0; i < poses; ++i) {
        const double error = std::exp(chance.between(-1.4, 1.4));
        *camera.get<scene::Camera>() = any_camera(chance, test::surface_of(node));
        node.get<scene::TerrainNode>()->material.technique =
            scene::parse_technique(fmt::format("polygons:error={},morph={}", error, morph)).value();
        driver.select(scene);
        const view::DrawnHits drawn = test::must(driver.draw_selected_hits());
        const double stated = std::max(error, drawn.stats.kept_error.value_or(error));
        promise.stated = std::max(promise.stated, stated / error);
        judge(scene, node, drawn.hits, stated, promise);
    }
    return promise;
}

void expect_kept(const Promise& promise) {
    EXPECT_GT(promise.pixels, 20000);
    EXPECT_EQ(promise.violations, 0) << "worst " << promise.worst << " of the error asked for";
    EXPECT_EQ(promise.holes, 0);
    EXPECT_EQ(promise.stated, 1.0);
}

TEST_F(PolygonsErrorGlTest, NoPixelOfAnyPoseIsFartherOffThanAskedFor) {
    expect_kept(
        promise_over(test::plane_heightfield(test::hills(200, 161, 60.0), {10, 10}), 40, 1));
    expect_kept(promise_over(
        test::plane_heightfield(test::random_heights(65, 65, 0.0F, 8.0F, 3), {5, 7}), 40, 2));
}

TEST_F(PolygonsErrorGlTest, NorWhileVerticesRise) {
    expect_kept(promise_over(test::plane_heightfield(test::hills(200, 161, 60.0), {10, 10}), 20, 11,
                             {}, 1));
    expect_kept(
        promise_over(test::geographic_heightfield(test::hills(161, 140, 600.0), 46.0, 7.0, 0.004),
                     15, 12, {}, 1));
}

// Walls that are seen edge-on, from a step away: what floats interpolate over a triangle much
// narrower than a step of the rasterizer's grid is off by pixels. (A guard band about the picture,
// so that none is cut, makes the worst seven times as bad: the triangles get longer.)
TEST_F(PolygonsErrorGlTest, NorBetweenTowersWhereNoSliverIsCut) {
    const Promise promise = promise_over(
        test::plane_heightfield(test::made_heights(129, 129,
                                                   [](int col, int row) {
                                                       const bool tower =
                                                           (col / 9 * 7 + row / 11 * 5) % 4 == 0 &&
                                                           col % 9 > 2 && row % 11 > 3;
                                                       return tower ? 140.0 : 0.0;
                                                   })),
        12, 6);
    EXPECT_GT(promise.pixels, 100000);
    EXPECT_LE(promise.violations, promise.pixels / 5000);
    EXPECT_LE(promise.worst, 3.0);
    EXPECT_EQ(promise.holes, 0);
}

TEST_F(PolygonsErrorGlTest, NorFromAnEyeNearTheGround) {
    const auto near_ground = [](terrain::Heightfield heightfield, unsigned seed, int morph = 0) {
        return promise_over(std::move(heightfield), 40, seed, {}, morph, camera_near_the_ground);
    };
    expect_kept(near_ground(test::plane_heightfield(test::hills(200, 161, 600.0), {25, 25}), 21));
    expect_kept(
        near_ground(test::plane_heightfield(test::hills(200, 161, 600.0), {25, 25}), 22, 1));
    expect_kept(
        near_ground(test::plane_heightfield(test::random_heights(65, 65, 0.0F, 8.0F, 3)), 23));
    expect_kept(near_ground(
        test::geographic_heightfield(test::hills(161, 140, 600.0), 46.0, 7.0, 0.001), 24));
}

// Triangles next to the eye that reach far beyond the near plane: floats between corners that are
// millions of pixels outside the picture. Smaller triangles end at a part of a cell.
TEST_F(PolygonsErrorGlTest, NorFartherThanStatedNearTheGroundOfHugeCells) {
    const auto near_ground = [](terrain::Heightfield heightfield, unsigned seed) {
        const Promise promise =
            promise_over(std::move(heightfield), 25, seed, {}, 0, camera_near_the_ground);
        EXPECT_GT(promise.pixels, 20000);
        EXPECT_EQ(promise.violations, 0) << promise.worst << " of what is stated";
        EXPECT_EQ(promise.holes, 0);
    };
    for (const double spacing : {2e3, 5e4}) {
        near_ground(test::plane_heightfield(test::hills(65, 65, 600.0), {spacing, spacing}), 31);
    }
    near_ground(test::plane_heightfield(Grid<float>(65, 65, 5.0F), {3e4, 3e4}), 32);
    near_ground(test::closed_globe(60, 0.5, 0.5, 7), 33);
}

// At column 39,000 a float has steps of 1/256 sample, here 0.1 m.
TEST_F(PolygonsErrorGlTest, NorWhereFloatsCannotHoldTheColumn) {
    constexpr int cols = 40'000;
    scene::Scene scene;
    scene::Node& node = test::add_terrain(
        scene, test::plane_heightfield(test::made_heights(cols, 5,
                                                          [](int col, int row) {
                                                              return 2.0 * std::sin(col) +
                                                                     3.0 * std::cos(row);
                                                          }),
                                       {25.0, 25.0}));
    const auto& surface = test::surface_of(node);
    const double x = (39'000.3 - 0.5 * (cols - 1)) * 25.0;
    scene::Camera camera =
        scene::camera_from_angles({x, 1.0, surface.height_at(x, 1.0).value() + 0.5}, 80.0, -20.0);
    camera.near = 0.01;
    scene.add_camera(camera);
    constexpr double error = 0.1;
    node.get<scene::TerrainNode>()->material.technique =
        scene::Technique{scene::Polygons{.error = error}};
    session::SceneRenderer driver = test::must(test::make_renderer(picture));
    HitBuffer hits = test::must(driver.draw_hits(scene));
    const SurfaceView view{surface.heightfield().heights.view(), surface.placement(),
                           node.world_from_local(), camera};
    Promise promise;
    judge(scene, node, hits, error, promise);
    EXPECT_GT(promise.pixels, 5000);
    EXPECT_EQ(promise.violations, 0) << "worst " << promise.worst << " of the error asked for";
    Hit rounded = hits(picture.x / 2, picture.y - 1);
    rounded.col_low = 0.0F;
    rounded.col = std::nextafter(rounded.col, 0.0F);
    EXPECT_GT(reprojection_error(view, picture, {picture.x / 2, picture.y - 1}, rounded), 1.0);
}

TEST_F(PolygonsErrorGlTest, NorOverTheCurvedEarth) {
    RELJEF_RELEASE_ONLY("the same lines draw flat terrain");
    expect_kept(promise_over(
        test::geographic_heightfield(test::hills(161, 140, 600.0), 46.0, 7.0, 0.004), 30, 3));
}

TEST_F(PolygonsErrorGlTest, NorExaggerated) {
    expect_kept(promise_over(test::plane_heightfield(test::hills(131, 90, 6.0), {10, 10}), 20, 4,
                             {.placement = {}, .exaggeration = 20.0}));
}

// A window of an SRTM tile: 1201 rows of 1201 heights, 16 bits, the high byte first.
Grid<float> real_heights(glm::ivec2 first, int side) {
    constexpr int tile_side = 1201;
    const std::string bytes = test::read_bytes(test::data_path(alps));
    return test::made_heights(side, side, [&](int col, int row) {
        const auto at = 2U * static_cast<std::size_t>((first.y + row) * tile_side + first.x + col);
        const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
        return static_cast<std::int16_t>(byte(at) << 8U | byte(at + 1));
    });
}

TEST_F(PolygonsErrorGlTest, NorOnARealTerrain) {
    RELJEF_NEED_DATA(alps);
    expect_kept(
        promise_over(test::plane_heightfield(real_heights({700, 100}, 400), {65.0, 92.6}), 40, 5));
}

TEST_F(PolygonsErrorGlTest, ALevelSurfaceTakesTheFewestTriangles) {
    scene::Scene scene;
    scene::Node& node =
        test::add_terrain(scene, test::plane_heightfield(Grid<float>(257, 257, 3.0F)));
    scene::Node& camera = scene.add_camera(test::camera_at({0.0, -500.0, 80.0}, {0.0, 0.0, 0.0}));
    node.get<scene::TerrainNode>()->material.technique =
        scene::parse_technique("polygons:error=0.1").value();
    session::SceneRenderer driver = test::must(test::make_renderer(picture));
    EXPECT_EQ(test::must(driver.draw(scene)).triangles, 16U);
    // Triangles that the near plane may cut are smaller: floats round what lies far beside them.
    *camera.get<scene::Camera>() = test::camera_at({0.0, 0.0, 4.0}, {0.0, 100.0, 3.0});
    EXPECT_LE(test::must(driver.draw(scene)).triangles, 120U);
}

} // namespace
} // namespace reljef::truth
