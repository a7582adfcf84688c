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
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"
#include "tests/terrain/chance.h"
#include "tests/truth/techniques/error_promise.h"

namespace reljef::truth {
namespace {

constexpr const char* alps = "natural/srtm3/N45E006.hgt";

class PolygonsErrorGlTest : public test::GlTest {};

Promise promise_over(terrain::Heightfield heightfield, int poses, unsigned seed,
                     const scene::TerrainOptions& options = {}, int morph = 0,
                     ChanceCamera any_camera = chance_camera) {
    const char* const technique = morph == 1 ? "polygons:error={},morph=1" : "polygons:error={}";
    return promise_over(std::move(heightfield), PromiseOptions{.poses = poses,
                                                               .seed = seed,
                                                               .terrain = options,
                                                               .technique = technique,
                                                               .any_camera = any_camera,
                                                               .costs = {}});
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
    expect_kept(promise);
}

// From a few metres away or from above, with any field of view.
scene::Camera camera_beside_walls(test::Chance& chance, const scene::TerrainSurface& surface) {
    const Box& bounds = surface.bounds();
    scene::Camera camera;
    camera.eye = {chance.between(bounds.low.x, bounds.high.x),
                  chance.between(bounds.low.y, bounds.high.y), 0.0};
    const double above = std::exp(chance.between(-1.0, 5.0));
    camera.eye.z = surface.height_at(camera.eye.x, camera.eye.y).value_or(0.0) + above;
    camera.target = camera.eye + glm::dvec3(chance.between(-1.0, 1.0), chance.between(-1.0, 1.0),
                                            chance.between(-1.0, 0.5));
    camera.vertical_fov =
        chance.one_in(2) ? chance.between(0.05, 10.0) : chance.between(20.0, 155.0);
    camera.near = 0.01;
    return camera;
}

// Walls 600 times as high as their cell is wide: slivers down to a millionth of a pixel.
TEST_F(PolygonsErrorGlTest, NorAmongPalisadesOfSlivers) {
    for (const double height : {60.0, 300.0}) {
        const Grid<float> blocks = test::random_heights(32, 32, -2.0F, 1.0F, 17);
        const auto heights = test::made_heights(253, 253, [&](int col, int row) {
            return height * std::max(0.0F, blocks(col / 8, row / 8));
        });
        const int poses = test::cases(10, 30);
        const Promise promise = promise_over(test::plane_heightfield(heights, {0.5, 0.5}), poses,
                                             14, {}, 0, camera_beside_walls);
        EXPECT_GT(promise.pixels, 6000 * poses);
        EXPECT_EQ(promise.violations, 0) << promise.worst;
        EXPECT_EQ(promise.holes, 0);
    }
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

// Floats resolve 2^-24 of a distance, which narrow views show as pixels.
TEST_F(PolygonsErrorGlTest, NarrowViewsStateWhatFloatsRound) {
    for (const char* technique : {"polygons:error={}", "auto:error={}"}) {
        PromiseOptions options;
        options.poses = 60;
        options.seed = 12;
        options.technique = technique;
        options.any_camera = narrow_camera;
        const Promise promise =
            promise_over(test::plane_heightfield(test::hills(380, 361, 60.0)), options);
        EXPECT_GT(promise.pixels, 100000);
        EXPECT_EQ(promise.violations, 0) << technique << ": " << promise.worst;
        EXPECT_EQ(promise.holes, 0);
        EXPECT_GT(promise.worst, 0.1);
        EXPECT_GT(promise.stated, 2.0);
    }
}

// A place that is rounded along the ground is off by the height of a wall.
TEST_F(PolygonsErrorGlTest, WallsSeenFromAfarAreNoFartherOff) {
    const auto heights = test::made_heights(200, 200, [](int col, int row) {
        return col / 40 % 2 == 1 && row / 40 % 2 == 1 ? 60.0 : 0.0;
    });
    const Promise promise = promise_over(test::plane_heightfield(heights, {0.5, 0.5}), 30, 13, {},
                                         0, far_narrow_camera);
    EXPECT_GT(promise.pixels, 50000);
    EXPECT_EQ(promise.violations, 0) << promise.worst;
    EXPECT_EQ(promise.holes, 0);
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
    // Next to the eye triangles are smaller: floats round corners that are far away.
    *camera.get<scene::Camera>() = test::camera_at({0.0, 0.0, 4.0}, {0.0, 100.0, 3.0});
    EXPECT_LE(test::must(driver.draw(scene)).triangles, 500U);
}

} // namespace
} // namespace reljef::truth
