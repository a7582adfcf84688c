#include "engine/core/stopwatch.h"
#include "engine/render/driver.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include <glad/gl.h>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/render/shaders/frame_block.h"
#include "tests/render/driver_fixture.h"
#include "tests/session/made_session.h"

namespace reljef::render {
namespace {

TEST_F(DriverGlTest, AMapHasNorthUpAndEastRight) {
    Scene scene;
    Image color(64, 64, Rgba8{20, 20, 20, 255});
    for (int row = 0; row < 16; ++row) {
        for (int col = 48; col < 64; ++col) {
            color(col, row) = {255, 255, 255, 255};
        }
    }
    Node& terrain = test::add_terrain(
        scene,
        test::plane_heightfield(test::made_heights(
            64, 64, [](int col, int row) { return col >= 48 && row < 16 ? 5.0 : 0.0; })),
        color);
    scene.add_camera(pose(scene::Pose::map, terrain));
    session::SceneRenderer made = driver();
    test::must(made.draw(scene));
    const Image picture = made.read_color();
    const HitBuffer hits = test::must(made.draw_hits(scene));
    int bright = 0;
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const Hit& hit = hits(x, y);
            if (hit.is_sky()) {
                continue;
            }
            const bool north_east = hit.col > 49.0F && hit.row < 14.0F;
            const bool elsewhere = hit.col < 46.0F || hit.row > 17.0F;
            if (north_east) {
                ++bright;
                ASSERT_GT(x, size.x / 2);
                ASSERT_LT(y, size.y / 2);
                ASSERT_GT(picture(x, y).g, 250);
                ASSERT_EQ(hit.height, 5.0F);
            } else if (elsewhere) {
                ASSERT_LT(picture(x, y).g, 40);
                ASSERT_EQ(hit.height, 0.0F);
            }
        }
    }
    EXPECT_GT(bright, 1000);
}

TEST_F(DriverGlTest, ASunInTheEastLightsTheSlopesThatFaceEast) {
    Scene scene;
    Node& terrain = test::add_terrain(
        scene, test::plane_heightfield(test::made_heights(
                   65, 65, [](int col, int) { return 20.0 - 0.5 * std::abs(col - 32.0); })));
    scene.add_camera(pose(scene::Pose::map, terrain));
    Node& sun = scene.add_light({.azimuth = 90.0, .altitude = 40.0});
    Image picture = draw(scene);
    EXPECT_GT(brightness(picture(200, 120)), brightness(picture(120, 120)) + 100);
    sun.get<scene::Light>()->azimuth = 270.0;
    picture = draw(scene);
    EXPECT_GT(brightness(picture(120, 120)), brightness(picture(200, 120)) + 100);
}

// A GPU whose shader ran for too long leaves a black picture.
TEST_F(DriverGlTest, ALostContextIsAnErrorAndNoBlackPicture) {
    Scene scene;
    test::add_terrain(scene, test::plane_heightfield(Grid<float>(9, 9, 0.0F)));
    scene.add_camera(camera_at({4.0, -3.0, 9.0}, {4.0, 4.0, 0.0}));
    session::SceneRenderer driver = test::must(test::make_renderer(size));
    test::must(driver.draw(scene)); // which does not wait for the GPU
    ASSERT_TRUE(driver.check_drawn());
    const auto before = std::exchange(
        glad_glGetGraphicsResetStatus,
        +[]() GLAD_API_PTR -> GLenum { return GL_GUILTY_CONTEXT_RESET; });
    const auto drawn = driver.check_drawn();
    glad_glGetGraphicsResetStatus = before; // drivers tell it once
    ASSERT_FALSE(drawn);
    EXPECT_THAT(drawn.error().message, ::testing::HasSubstr("the graphics driver gave up"));
    EXPECT_FALSE(driver.draw(scene));
    EXPECT_FALSE(driver.draw(scene, true));
    EXPECT_FALSE(driver.draw_hits(scene));
}

TEST_F(DriverGlTest, ATurnedTerrainIsLitByTheSameSun) {
    Scene scene;
    Node& terrain = test::add_terrain(
        scene, test::plane_heightfield(test::made_heights(
                   65, 65, [](int col, int) { return 20.0 - 0.5 * std::abs(col - 32.0); })));
    scene.add_camera(pose(scene::Pose::map, terrain));
    scene.add_light({.azimuth = 90.0, .altitude = 40.0});
    terrain.set_parent_from_local(glm::rotate(glm::dmat4(1.0), std::acos(-1.0), {0.0, 0.0, 1.0}));
    const Image picture = draw(scene);
    EXPECT_GT(brightness(picture(200, 120)), brightness(picture(120, 120)) + 100);
}

// A node twice as large has the same slopes and the same light.
TEST_F(DriverGlTest, AScaledTerrainIsLitAsAnyOther) {
    World world;
    world.scene.remove_sky();
    const Image before = draw(world.scene);
    Camera camera = world.scene.camera();
    camera.eye *= 2.0;
    camera.target *= 2.0;
    world.look(camera);
    world.terrain->set_parent_from_local(glm::scale(glm::dmat4(1.0), glm::dvec3(2.0)));
    const Image after = draw(world.scene);
    int different = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        different +=
            std::abs(brightness(before.samples()[i]) - brightness(after.samples()[i])) > 6 ? 1 : 0;
    }
    EXPECT_LE(different, 8);
}

TEST_F(DriverGlTest, TwoNodesMayShareASurface) {
    Scene scene;
    Node& one = test::add_terrain(scene, test::plane_heightfield(test::made_heights(
                                             33, 33, [](int col, int) { return 0.5 * col; })));
    Node& other = scene.root().add("other", *one.get<scene::TerrainNode>());
    one.set_position({-20.0, 0.0, 0.0});
    // The other one is turned: its slope faces east, the first one's west.
    other.set_parent_from_local(glm::rotate(glm::translate(glm::dmat4(1.0), {20.0, 0.0, 0.0}),
                                            std::acos(-1.0), {0.0, 0.0, 1.0}));
    scene.add_camera(scene::pose_camera(scene::Pose::map, scene.root().world_bounds(), {}));
    scene.add_light({.azimuth = 90.0, .altitude = 20.0});
    session::SceneRenderer made = driver();
    test::must(made.draw(scene));
    const Image picture = made.read_color();
    EXPECT_GT(brightness(picture(240, 120)), brightness(picture(80, 120)) + 60);
}

TEST_F(DriverGlTest, ASecondFrameUploadsTheFrameBlockOnly) {
    World world;
    world.look(camera_at({0.0, -350.0, 250.0}, {0.0, 0.0, 0.0}));
    session::SceneRenderer made = driver();
    const view::FrameStats first = test::must(made.draw(world.scene));
    EXPECT_EQ(first.tiles, 9);
    EXPECT_EQ(first.triangles, 2U * 300U * 300U);
    EXPECT_EQ(first.draws, 10) << "the sky's included";
    EXPECT_GT(first.upload_bytes, 300U * 300U * 16U);
    const Image picture = made.read_color();
    const view::FrameStats second = test::must(made.draw(world.scene));
    EXPECT_EQ(second.uploads, 1);
    EXPECT_EQ(second.upload_bytes, sizeof(FrameBlock));
    EXPECT_EQ(second.skipped.uploads_unchanged, 9 + 1) << "nine tiles and the maps";
    EXPECT_EQ(made.read_color(), picture);
}

TEST_F(DriverGlTest, NoPartOfAFrameIsTimedTwice) {
    World world;
    session::SceneRenderer made = driver();
    world.terrain->get<scene::TerrainNode>()->material.technique = {scene::Polygons{}};
    test::must(made.draw(world.scene));
    for (int frame = 0; frame < 5; ++frame) {
        const Stopwatch whole; // its parts are no longer, however busy the machine is
        const view::FrameStats stats = test::must(made.draw(world.scene, true));
        EXPECT_LE(stats.cpu_ms + stats.gpu_ms, whole.milliseconds());
        EXPECT_GE(stats.cpu_ms, 0.0);
        EXPECT_GT(stats.gpu_ms, 0.0);
    }
}

TEST_F(DriverGlTest, AMovedSunUploadsTheMapsAgain) {
    World world;
    session::SceneRenderer made = driver();
    test::must(made.draw(world.scene));
    const Image before = made.read_color();
    for (const auto& child : world.scene.root().children()) {
        if (auto* light = child->get<scene::Light>()) {
            light->azimuth += 90.0;
        }
    }
    const view::FrameStats stats = test::must(made.draw(world.scene));
    EXPECT_EQ(stats.uploads, 1 + 1) << "the map of what is lit";
    EXPECT_NE(made.read_color(), before);
    EXPECT_EQ(test::must(made.draw(world.scene)).uploads, 1);
}

TEST_F(DriverGlTest, WhatIsGoneFromTheSceneLeavesTheDriver) {
    Scene scene;
    scene.add_camera(camera_at({0.0, -40.0, 30.0}, {0.0, 0.0, 0.0}));
    session::SceneRenderer made = driver();
    for (int i = 0; i < 20; ++i) {
        Node& terrain = test::add_terrain(
            scene, test::plane_heightfield(Grid<float>(20, 20, 0.1F * static_cast<float>(i))));
        const view::FrameStats stats = test::must(made.draw(scene));
        EXPECT_GE(stats.uploads, 3)
            << "a new surface is uploaded, even at an address of an old one";
        (void)scene.root().remove(terrain);
    }
}

int terrain_pixels(const HitBuffer& hits) {
    return static_cast<int>(std::count_if(hits.samples().begin(), hits.samples().end(),
                                          [](const Hit& hit) { return !hit.is_sky(); }));
}

TEST_F(DriverGlTest, AWireframeCoversFewerPixels) {
    Scene scene;
    Node& terrain =
        test::add_terrain(scene, test::plane_heightfield(test::hills(20, 20, 1.0), {10.0, 10.0}));
    scene.add_camera(pose(scene::Pose::overview, terrain));
    session::SceneRenderer made = driver();
    const int filled = terrain_pixels(test::must(made.draw_hits(scene)));
    terrain.get<scene::TerrainNode>()->material.wireframe = true;
    const int lines = terrain_pixels(test::must(made.draw_hits(scene)));
    EXPECT_GT(lines, 1000);
    EXPECT_LT(lines, filled / 2);
    terrain.get<scene::TerrainNode>()->material.wireframe = false;
    EXPECT_EQ(terrain_pixels(test::must(made.draw_hits(scene))), filled) << "the mode is set back";
}

// Mesa draws lines of several samples black.
TEST_F(DriverGlTest, AWireframeHasOneSample) {
    World world;
    session::SceneRenderer made = driver();
    const auto drawn = [&](int samples) {
        made.set_samples(samples);
        test::must(made.draw(world.scene));
        return made.read_color();
    };
    EXPECT_NE(drawn(4), drawn(1));
    world.terrain->get<scene::TerrainNode>()->material.wireframe = true;
    EXPECT_EQ(drawn(4), drawn(1));
}

TEST_F(DriverGlTest, AResizedOneDrawsAsOneMadeOfThatSize) {
    World world;
    session::SceneRenderer made = driver({100, 50});
    test::must(made.draw(world.scene));
    EXPECT_EQ(made.read_color().cols(), 100);
    EXPECT_EQ(test::must(made.draw_hits(world.scene)).rows(), 50);
    ASSERT_TRUE(made.resize(size));
    EXPECT_EQ(made.size(), size);
    test::must(made.draw(world.scene));
    EXPECT_EQ(made.read_color(), draw(world.scene));
    EXPECT_EQ(test::must(made.draw_hits(world.scene)).cols(), size.x);
    EXPECT_FALSE(made.resize({0, 10}));
    EXPECT_FALSE(made.resize({1 << 20, 10}));
    EXPECT_EQ(made.size(), size) << "a failed one changes nothing";
    EXPECT_TRUE(made.draw(world.scene));
}

TEST_F(DriverGlTest, ASizeThatCannotBeIsAnError) {
    EXPECT_FALSE(test::make_renderer({0, 0}));
    EXPECT_FALSE(test::make_renderer({100000, 100000}));
}

TEST_F(DriverGlTest, WithoutSunAndSkyTheImageryItselfShows) {
    Scene scene;
    Node& terrain = test::add_terrain(scene, test::plane_heightfield(test::hills(50, 50, 1.0)),
                                      Image(50, 50, Rgba8{100, 150, 200, 255}));
    scene.add_camera(pose(scene::Pose::overview, terrain));
    session::SceneRenderer made = driver();
    const view::FrameStats stats = test::must(made.draw(scene));
    EXPECT_EQ(stats.draws, 1);
    EXPECT_EQ(stats.skipped.sky, 1);
    const Image picture = made.read_color();
    EXPECT_EQ(picture(0, 0), (Rgba8{0, 0, 0, 255}));
    const Rgba8 ground = picture(size.x / 2, size.y / 2);
    EXPECT_NEAR(ground.r, 100, 1);
    EXPECT_NEAR(ground.g, 150, 1);
    EXPECT_NEAR(ground.b, 200, 1);
}

TEST_F(DriverGlTest, AnEmptySceneIsSky) {
    Scene scene;
    session::SceneRenderer made = driver();
    EXPECT_EQ(test::must(made.draw(scene)).draws, 0);
    scene.set_sky({});
    EXPECT_EQ(test::must(made.draw(scene)).draws, 1);
    const HitBuffer hits = test::must(made.draw_hits(scene));
    EXPECT_EQ(terrain_pixels(hits), 0);
    EXPECT_EQ(hits(5, 5).depth, infinity);
}

TEST_F(DriverGlTest, FogHidesWhatIsFarAway) {
    World world;
    scene::Sky sky;
    sky.visibility = 30.0;
    sky.glow = glm::vec3(0.0F);
    const Image clear = draw(world.scene);
    world.scene.set_sky(sky);
    const Image foggy = draw(world.scene);
    const Rgba8 horizon = rgba8_from_linear(sky.horizon);
    const Rgba8 far = foggy(size.x / 2, size.y / 3);
    EXPECT_NEAR(far.r, horizon.r, 3);
    EXPECT_NEAR(far.b, horizon.b, 3);
    EXPECT_NE(clear(size.x / 2, size.y / 3), far);
}

int different_pixels(const Image& a, const Image& b, int tolerance) {
    int count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const Rgba8 p = a.samples()[i];
        const Rgba8 q = b.samples()[i];
        count +=
            std::max({std::abs(p.r - q.r), std::abs(p.g - q.g), std::abs(p.b - q.b)}) > tolerance
                ? 1
                : 0;
    }
    return count;
}

TEST_F(DriverGlTest, TenThousandKilometresAwayThePictureIsTheSame) {
    World world;
    const Image here = draw(world.scene);
    const Camera camera = world.scene.camera();
    for (const glm::dvec3 offset :
         {glm::dvec3(1e7, -1e7, 1e6), glm::dvec3(1e7 + 0.001, 2e6, -3e6)}) {
        world.terrain->set_position(offset);
        Camera moved = camera;
        moved.eye += offset;
        moved.target += offset;
        world.look(moved);
        EXPECT_LE(different_pixels(here, draw(world.scene), 1), size.x * size.y / 10000);
    }
}

TEST_F(DriverGlTest, AMillimetreFarAwayIsSeen) {
    World world;
    const glm::dvec3 offset(1e7, -1e7, 1e6);
    const double ground = surface_of(*world.terrain).height_at(0.0, 0.0).value();
    const auto depth_below = [&](double shift) {
        world.terrain->set_position(offset + glm::dvec3(0.0, 0.0, shift));
        world.look(camera_at(offset + glm::dvec3(0.0, 0.0, ground + 1.0),
                             offset + glm::dvec3(0.0, 0.0, ground)));
        return test::must(driver().draw_hits(world.scene))(size.x / 2, size.y / 2).depth;
    };
    EXPECT_NEAR(depth_below(0.0) - depth_below(0.001), 0.001F, 2e-5F);
}

TEST_F(DriverGlTest, AMeshInFrontHidesTheTerrain) {
    World world;
    Node& box = world.scene.add_mesh(scene::box_mesh(glm::vec3(10.0F)));
    world.look(camera_at({0.0, -100.0, 60.0}, {0.0, 0.0, 20.0}));
    box.set_position({0.0, 0.0, 20.0});
    session::SceneRenderer made = driver();
    test::must(made.draw(world.scene));
    const HitBuffer hits = test::must(made.draw_hits(world.scene));
    const Hit& middle = hits(size.x / 2, size.y / 2);
    EXPECT_FALSE(middle.is_sky());
    EXPECT_EQ(middle.col, -1.0F);
    EXPECT_EQ(middle.row, -1.0F);
    EXPECT_NEAR(middle.depth, glm::length(glm::dvec3(0.0, 100.0, 40.0)) - 5.0, 1.5);
    box.set_position({0.0, 200.0, -200.0});
    EXPECT_GE(test::must(made.draw_hits(world.scene))(size.x / 2, size.y / 2).col, 0.0F);
}

// Depths along the view axis of an orthographic camera may be negative.
TEST_F(DriverGlTest, AnOrthographicCameraSeesWhatIsBehindItsEye) {
    World world;
    world.scene.add_mesh(scene::box_mesh(glm::vec3(20.0F))).set_position({0.0, 0.0, 40.0});
    Camera map = pose(scene::Pose::map, *world.terrain);
    map.eye.z = -200.0;
    map.target.z = -201.0;
    world.look(map);
    const HitBuffer hits = test::must(driver().draw_hits(world.scene));
    const Hit& box = hits(size.x / 2, size.y / 2);
    EXPECT_EQ(box.col, -1.0F);
    EXPECT_NEAR(box.depth, -250.0F, 1e-2F);
    const Hit& ground = hits(size.x / 2, 40);
    EXPECT_GE(ground.col, 0.0F);
    EXPECT_NEAR(ground.depth, -200.0F - ground.height, 1e-2F);
}

TEST_F(DriverGlTest, TheTextureTechniqueIsFlatAtTheMiddleOfTheRange) {
    World world;
    world.terrain->get<scene::TerrainNode>()->material.technique =
        scene::make_technique(scene::TechniqueId::texture);
    world.look(camera_at({0.0, -350.0, 250.0}, {0.0, 0.0, 0.0}));
    session::SceneRenderer made = driver();
    EXPECT_EQ(test::must(made.draw(world.scene)).triangles, 2U * 9U);
    const HitBuffer hits = test::must(made.draw_hits(world.scene));
    const double reference = terrain::reference_height(surface_of(*world.terrain).heightfield());
    int count = 0;
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const Hit& hit = hits(x, y);
            if (!hit.is_sky()) {
                ++count;
                ASSERT_NEAR(hit.height, reference, 1e-4);
                const auto back =
                    scene::project(world.scene.camera(), size,
                                   surface_of(*world.terrain)
                                       .placement()
                                       .world_from_sample({hit.col, hit.row, hit.height}));
                ASSERT_LE(glm::distance(back.pixel, glm::dvec2(x + 0.5, y + 0.5)), 0.01);
            }
        }
    }
    EXPECT_GT(count, 10000);
}

TEST_F(DriverGlTest, CamerasThatAreNowhereDrawNothingAndDoNoHarm) {
    World world;
    session::SceneRenderer made = driver();
    const double nan = std::nan("");
    for (const Camera& camera :
         {camera_at(glm::dvec3(nan), glm::dvec3(0.0)), camera_at(glm::dvec3(0.0), glm::dvec3(0.0)),
          camera_at({0.0, 0.0, 1e300}, glm::dvec3(0.0)),
          camera_at({0.0, 0.0, -500.0}, {0.0, 0.0, 0.0}),
          camera_at({0.0, 0.0, 500.0}, {0.0, 0.0, 0.0})}) {
        world.look(camera);
        EXPECT_TRUE(made.draw(world.scene));
        EXPECT_TRUE(made.draw_hits(world.scene));
    }
}

// Those of one part were kept for the next, where other triangles are seen.
TEST_F(DriverGlTest, SliversOfAPartOfAPictureDoNotDependOnThePartBefore) {
    Scene scene;
    const Grid<float> blocks = test::random_heights(16, 16, -2.0F, 1.0F, 17);
    const auto walls = test::made_heights(125, 125, [&](int col, int row) {
        return 60.0 * std::max(0.0F, blocks(col / 8, row / 8));
    });
    Node& terrain = test::add_terrain(scene, test::plane_heightfield(walls, {0.5, 0.5}));
    terrain.get<scene::TerrainNode>()->material.technique =
        scene::parse_technique("polygons:error=1").value();
    Node& camera = scene.add_camera();
    const Camera whole = camera_at({-30.0, -30.0, 40.0}, {0.0, 0.0, 20.0});
    const auto look_at_part = [&](glm::ivec2 first) {
        *camera.get<Camera>() = scene::part_camera(whole, 2 * size, {first, size});
    };
    session::SceneRenderer kept = driver();
    int slivers = 0;
    for (const glm::ivec2 first : {glm::ivec2(0, 0), {size.x, 0}, {0, size.y}, size}) {
        look_at_part(first);
        session::SceneRenderer fresh = driver();
        const view::FrameStats found = test::must(fresh.draw(scene));
        const auto expected = found.slivers;
        EXPECT_EQ(test::must(kept.draw(scene)).slivers, expected);
        EXPECT_EQ(kept.read_color(), fresh.read_color());
        slivers += static_cast<int>(expected);
    }
    EXPECT_GT(slivers, 50);
}

} // namespace
} // namespace reljef::render
