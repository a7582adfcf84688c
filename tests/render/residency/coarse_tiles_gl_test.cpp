// Tiles with fewer triangles than samples: what is drawn, kept and uploaded.
#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "tests/render/driver_fixture.h"
#include "tests/session/made_session.h"

namespace reljef::render {
namespace {

void set_technique(Node& terrain, const std::string& text) {
    terrain.get<scene::TerrainNode>()->material.technique = scene::parse_technique(text).value();
}

TEST_F(DriverGlTest, AStillCameraCutsAndUploadsNothing) {
    World world;
    set_technique(*world.terrain, "polygons:error=0.5");
    session::SceneRenderer made = driver();
    const view::FrameStats first = test::must(made.draw(world.scene));
    EXPECT_EQ(first.tiles_cut, first.tiles);
    EXPECT_GT(first.skipped.triangles_under_error, 0U);
    const view::FrameStats still = test::must(made.draw(world.scene));
    EXPECT_EQ(still.tiles_cut, 0);
    EXPECT_EQ(still.skipped.cuts_unchanged, still.tiles);
    EXPECT_EQ(still.uploads, 1) << "the frame's own block";
    EXPECT_EQ(still.triangles, first.triangles);
}

TEST_F(DriverGlTest, AMovedCameraUploadsOnlyTilesWhoseTrianglesChanged) {
    World world;
    set_technique(*world.terrain, "polygons:error=2");
    session::SceneRenderer made = driver();
    test::must(made.draw(world.scene));
    Camera camera = world.scene.camera();
    camera.eye.x += 1e-6;
    world.look(camera);
    const view::FrameStats moved = test::must(made.draw(world.scene));
    EXPECT_EQ(moved.tiles_cut, moved.tiles);
    EXPECT_EQ(moved.skipped.cuts_unchanged, 0);
    EXPECT_EQ(moved.uploads, 1) << "the same triangles";
}

TEST_F(DriverGlTest, ALowerErrorTakesMoreTriangles) {
    World world;
    session::SceneRenderer made = driver();
    std::size_t before = 0;
    for (const char* error : {"16", "4", "1", "0.25"}) {
        set_technique(*world.terrain, std::string("polygons:error=") + error);
        const std::size_t triangles = test::must(made.draw(world.scene)).triangles;
        EXPECT_GT(triangles, before) << error;
        before = triangles;
    }
}

TEST_F(DriverGlTest, MoreLevelsTakeFewerTriangles) {
    World world;
    session::SceneRenderer made = driver();
    std::size_t before = std::numeric_limits<std::size_t>::max();
    for (const char* levels : {"1", "2", "3", "4"}) {
        set_technique(*world.terrain, std::string("polygons:lods=") + levels);
        const std::size_t triangles = test::must(made.draw(world.scene)).triangles;
        EXPECT_LT(triangles, before) << levels;
        before = triangles;
    }
}

TEST_F(DriverGlTest, ATechniqueThatIsTakenUpAgainIsCutAlready) {
    World world;
    session::SceneRenderer made = driver();
    for (const int cut : {9, 0}) {
        for (const char* technique : {"polygons:error=1", "polygons:lods=3", "texture"}) {
            set_technique(*world.terrain, technique);
            const int tiles = test::must(made.draw(world.scene)).tiles_cut;
            EXPECT_LE(tiles, cut) << technique;
        }
    }
}

TEST_F(DriverGlTest, TwoTerrainsOfOneSurfaceAreCutEachForItself) {
    World world;
    Node& other = world.scene.root().add(
        "other", scene::TerrainNode{*world.terrain->get<scene::TerrainNode>()});
    other.set_position({0.0, 400.0, 0.0});
    set_technique(*world.terrain, "polygons:error=1");
    set_technique(other, "polygons:error=1");
    session::SceneRenderer made = driver();
    const view::FrameStats first = test::must(made.draw(world.scene));
    EXPECT_EQ(first.tiles_cut, first.tiles);
    EXPECT_EQ(test::must(made.draw(world.scene)).tiles_cut, 0);
}

// Walls beside the eye are cut to small parts of a sample, however many triangles that takes.
TEST_F(DriverGlTest, CliffsNearTheEyeTakeNoMoreTrianglesThanAllowedAndTheErrorIsStated) {
    Scene scene;
    const auto cliffs = [](int col, int row) { return (col / 5 + row / 5) % 2 * 500.0; };
    Node& terrain =
        test::add_terrain(scene, test::plane_heightfield(test::made_heights(129, 129, cliffs)));
    auto& node = *terrain.get<scene::TerrainNode>();
    node.material.technique = scene::parse_technique("polygons:error=1").value();
    Node& camera = scene.add_camera(camera_at({2.0, 3.0, 500.5}, {30.0, 40.0, 470.0}));
    session::SceneRenderer made = driver();
    const auto all = test::must(made.draw(scene));
    EXPECT_FALSE(all.lacks_triangles);
    ASSERT_GT(all.triangles, 100'000U);
    ASSERT_TRUE(all.kept_error);
    double error = *all.kept_error;
    for (const std::size_t max : {std::size_t{60'000}, std::size_t{10'000}, std::size_t{500}}) {
        node.max_triangles = max;
        const auto some = test::must(made.draw(scene));
        EXPECT_TRUE(some.lacks_triangles);
        EXPECT_LE(some.triangles, max);
        EXPECT_GT(some.triangles, max / 16);
        ASSERT_TRUE(some.kept_error);
        EXPECT_GE(*some.kept_error, error);
        error = *some.kept_error;
    }
    // What is drawn does not depend on the views before.
    const Camera here = *camera.get<Camera>();
    node.max_triangles = 60'000;
    const auto first = test::must(made.draw_hits(scene));
    *camera.get<Camera>() = camera_at({2.0, 3.0, 900.0}, {0.0, 0.0, 0.0});
    test::must(made.draw(scene));
    *camera.get<Camera>() = here;
    EXPECT_TRUE(std::ranges::equal(
        first.samples(), test::must(made.draw_hits(scene)).samples(),
        [](const Hit& a, const Hit& b) { return a.depth == b.depth && a.col == b.col; }));
}

// Nearer ground whose triangles are off by more than the bound hides less than it was thought to.
TEST_F(DriverGlTest, TooFewTrianglesStateTheErrorOfWhatTheyHide) {
    constexpr double error_with_hidden = 7.0;
    World world;
    set_technique(*world.terrain, "polygons:error=0.25");
    Driver made = test::must(Driver::create({.size = size, .shader_dir = {}}));
    view::FrameView frame = view::select(world.scene, size);
    for (view::TileDraw& draw : frame.list.tiles) {
        draw.error_with_hidden = error_with_hidden;
    }
    const view::FrameStats all = test::must(made.draw(frame, false));
    ASSERT_FALSE(all.lacks_triangles);
    EXPECT_LT(all.kept_error.value(), error_with_hidden);
    world.terrain->get<scene::TerrainNode>()->max_triangles = all.triangles / 8;
    const view::FrameStats some = test::must(made.draw(frame, false));
    ASSERT_TRUE(some.lacks_triangles);
    EXPECT_GE(some.kept_error.value(), error_with_hidden);
}

} // namespace
} // namespace reljef::render
