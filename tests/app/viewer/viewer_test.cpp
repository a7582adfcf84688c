#include <chrono>
#include <filesystem>
#include <random>
#include <thread>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/viewer/viewer.h"
#include "engine/geo/place.h"
#include "tests/app/made_hill.h"
#include "tests/scene/technique/terrain_techniques.h"
#include "tests/support/temporary_folder.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::app {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double frame = 1.0 / 60.0;

session::SceneOptions from(glm::dvec3 eye) {
    session::SceneOptions view;
    view.eye = eye;
    view.target = glm::dvec3(0.0);
    return view;
}

// Nothing like a landscape: each sample is anywhere.
Grid<float> rubble(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> height(0.0F, 80.0F);
    Grid<float> heights(33, 33);
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            heights(col, row) = height(random);
        }
    }
    return heights;
}

// z of the triangle with these corners at x, y.
double plane_at(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, double x, double y) {
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    return a.z - (normal.x * (x - a.x) + normal.y * (y - a.y)) / normal.z;
}

// z of the drawn triangle at x, y, with either way to cut a cell in two.
double highest_triangle(const Grid<float>& heights, double x, double y) {
    const auto corner = [&](int col, int row) {
        return glm::dvec3(10.0 * (col - 16), 10.0 * (16 - row), heights(col, row));
    };
    const double col = x / 10.0 + 16.0;
    const double row = 16.0 - y / 10.0;
    const int c = std::clamp(static_cast<int>(col), 0, 31);
    const int r = std::clamp(static_cast<int>(row), 0, 31);
    const bool is_east = col - c > row - r;
    const bool is_south_east = col - c + row - r > 1.0;
    return std::max(plane_at(corner(c, r), corner(c + 1, r + 1),
                             is_east ? corner(c + 1, r) : corner(c, r + 1), x, y),
                    plane_at(corner(c + 1, r), corner(c, r + 1),
                             is_south_east ? corner(c + 1, r + 1) : corner(c, r), x, y));
}

struct ViewerTest : testing::Test {
    void press(Key key, Modifiers modifiers = {}) {
        viewer.receive(KeyEvent{.key = key, .pressed = true, .modifiers = modifiers});
        viewer.receive(KeyEvent{.key = key, .pressed = false, .modifiers = modifiers});
    }
    void hold(Key key) { viewer.receive(KeyEvent{.key = key, .pressed = true}); }
    void release(Key key) { viewer.receive(KeyEvent{.key = key, .pressed = false}); }
    void drag(glm::dvec2 from, glm::dvec2 to) {
        viewer.receive(MouseMoveEvent{from});
        viewer.receive(MouseButtonEvent{MouseButton::left, true, from});
        viewer.receive(MouseMoveEvent{to});
        viewer.receive(MouseButtonEvent{MouseButton::left, false, to});
    }
    void wait_for_maps() {
        while (viewer.is_preparing()) {
            viewer.advance(frame);
            std::this_thread::sleep_for(
                std::chrono::milliseconds(1)); // leaves the work a processor
        }
    }
    scene::Camera camera() { return *scene.camera->get<scene::Camera>(); }
    scene::Material& material() { return scene.terrain->get<scene::TerrainNode>()->material; }
    std::string title() { return viewer.title({}, {}); }

    session::TerrainScene scene = hill_scene();
    Viewer viewer{scene, scene::orbit_path(scene.bounds, 10.0), {400, 300}};
};

TEST_F(ViewerTest, DrawsAtFirstAndThenNothingWhileItIsStill) {
    EXPECT_TRUE(viewer.take_redraw());
    for (int i = 0; i < 100; ++i) {
        viewer.receive(MouseMoveEvent{{i * 1.0, i * 2.0}});
        viewer.receive(FocusEvent{i % 2 == 0});
        viewer.advance(frame);
        ASSERT_FALSE(viewer.take_redraw());
        ASSERT_FALSE(viewer.is_moving());
    }
}

TEST_F(ViewerTest, BeginsWithTheCameraOfItsScene) {
    session::TerrainScene fresh = hill_scene();
    const scene::Camera given = *fresh.camera->get<scene::Camera>();
    EXPECT_EQ(camera().eye, given.eye);
    EXPECT_LT(glm::distance(scene::view_axes(camera()).forward, scene::view_axes(given).forward),
              1e-9);
    EXPECT_EQ(camera().vertical_fov, given.vertical_fov);
    EXPECT_EQ(camera().near, given.near);
}

TEST_F(ViewerTest, HeldKeyMovesUntilItIsReleased) {
    const glm::dvec3 start = camera().eye;
    hold(Key::w);
    viewer.advance(frame);
    EXPECT_TRUE(viewer.is_moving());
    EXPECT_NE(camera().eye, start);
    release(Key::w);
    viewer.advance(frame);
    viewer.take_redraw();
    viewer.advance(frame);
    EXPECT_FALSE(viewer.is_moving());
    EXPECT_FALSE(viewer.take_redraw());
}

TEST_F(ViewerTest, RestIsNoFlyingTime) {
    viewer.advance(100.0);
    const glm::dvec3 start = camera().eye;
    hold(Key::w);
    viewer.advance(0.2);
    const double first = glm::distance(camera().eye, start);
    viewer.advance(0.2);
    EXPECT_NEAR(glm::distance(camera().eye, start), first * (1.0 + 0.2 * 60.0), 1e-6);
}

TEST(Viewer, HeldAgainstTheGroundItDrawsNothing) {
    session::TerrainScene scene = hill_scene(from({0.0, -80.0, 10.0}));
    Viewer walker{scene, scene::orbit_path(scene.bounds), {400, 300}};
    EXPECT_GT(scene.camera->get<scene::Camera>()->eye.z, 10.0);
    walker.take_redraw();
    walker.receive(KeyEvent{.key = Key::q, .pressed = true});
    walker.advance(frame);
    EXPECT_FALSE(walker.take_redraw());
    EXPECT_TRUE(walker.is_moving());
}

TEST(Viewer, IsNeverUnderADrawnTriangle) {
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        const Grid<float> heights = rubble(seed);
        session::TerrainScene scene = scene_of(rubble(seed));
        Viewer viewer{scene, scene::orbit_path(scene.bounds), {400, 300}};
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> any(-1.0, 1.0);
        viewer.receive(KeyEvent{.key = Key::q, .pressed = true});
        viewer.receive(KeyEvent{.key = Key::w, .pressed = true});
        viewer.receive(MouseButtonEvent{MouseButton::left, true});
        for (int step = 0; step < 400; ++step) {
            viewer.receive(MouseMoveEvent{{4000.0 * any(random), 300.0 * any(random)}});
            if (step % 50 == 0) {
                viewer.receive(KeyEvent{.key = Key::g, .pressed = true});
            }
            viewer.advance(0.05 + 0.05 * any(random));
            const glm::dvec3 eye = scene.camera->get<scene::Camera>()->eye;
            if (std::max(std::abs(eye.x), std::abs(eye.y)) < 159.9) {
                ASSERT_GT(eye.z, highest_triangle(heights, eye.x, eye.y) + 0.1)
                    << "seed " << seed << ", step " << step;
            }
        }
    }
}

TEST_F(ViewerTest, PFliesThePathAndStops) {
    press(Key::p);
    EXPECT_TRUE(viewer.is_playing());
    viewer.advance(frame);
    viewer.advance(1.0);
    const glm::dvec3 flying = camera().eye;
    viewer.advance(1.0);
    EXPECT_NE(camera().eye, flying);
    press(Key::p);
    viewer.take_redraw();
    viewer.advance(1.0);
    EXPECT_FALSE(viewer.take_redraw());
}

TEST_F(ViewerTest, PathBeginsAgainAtItsEnd) {
    press(Key::p);
    viewer.advance(frame);
    viewer.advance(3.0);
    const glm::dvec3 before = camera().eye;
    viewer.advance(10.0);
    EXPECT_LT(glm::distance(camera().eye, before), 1e-6);
}

TEST_F(ViewerTest, PathUnderTheGroundIsRaisedAndThatIsKnown) {
    press(Key::p);
    for (int i = 0; i < 50; ++i) {
        viewer.advance(0.2);
    }
    EXPECT_EQ(viewer.path_lifted(), 0.0) << "around the terrain, and above it";
    session::TerrainScene fresh = hill_scene();
    auto below = scene::CameraPath::create(
        {{0.0, {-100, -90, 40}, {0, 0, 0}}, {1.0, {100, -90, -20}, {0, 0, 0}}});
    Viewer raised{fresh, std::move(*below), {400, 300}};
    raised.toggle_path();
    for (int i = 0; i < 9; ++i) {
        raised.advance(0.1);
        EXPECT_GT(fresh.camera->get<scene::Camera>()->eye.z, 10.0);
    }
    EXPECT_GT(raised.path_lifted(), 10.0);
}

TEST_F(ViewerTest, SteeringTakesOverFromThePath) {
    for (const bool by_mouse : {false, true}) {
        press(Key::p);
        viewer.advance(frame);
        ASSERT_TRUE(viewer.is_playing());
        const glm::dvec3 there = camera().eye;
        by_mouse ? drag({10.0, 10.0}, {20.0, 10.0}) : press(Key::e);
        EXPECT_FALSE(viewer.is_playing());
        viewer.advance(frame);
        EXPECT_LT(glm::distance(camera().eye, there), 20.0);
    }
}

TEST_F(ViewerTest, PathOfOneKeyIsDrawnOnce) {
    session::TerrainScene fresh = hill_scene();
    Viewer still{
        fresh, scene::CameraPath::create({{0.0, {0, -90, 90}, {0, 0, 0}}}).value(), {400, 300}};
    still.toggle_path();
    still.advance(frame);
    EXPECT_TRUE(still.take_redraw());
    still.advance(1.0);
    EXPECT_FALSE(still.take_redraw());
}

TEST_F(ViewerTest, TimeThatIsNoTimeChangesNothing) {
    press(Key::p);
    viewer.advance(frame);
    for (const double seconds : {0.0, -5.0, 1e9, std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        viewer.advance(seconds);
        EXPECT_TRUE(std::isfinite(glm::length(camera().eye)));
        EXPECT_TRUE(std::isfinite(glm::length(camera().target)));
    }
}

TEST_F(ViewerTest, TAndDigitsSwitchTechniques) {
    const auto catalogue = scene::terrain_techniques();
    const auto first = material().technique.id();
    for (std::size_t i = 1; i <= catalogue.size(); ++i) {
        viewer.take_redraw();
        press(Key::t);
        wait_for_maps();
        EXPECT_EQ(material().technique.id() == first, i == catalogue.size());
        EXPECT_TRUE(viewer.take_redraw());
    }
    press(Key::digit1);
    EXPECT_EQ(material().technique.id(), catalogue[0].id);
    viewer.take_redraw();
    press(Key::digit1);
    EXPECT_FALSE(viewer.take_redraw()) << "the one it is";
}

TEST_F(ViewerTest, FShowsTheEdgesAndFillsAgain) {
    viewer.take_redraw();
    press(Key::f);
    EXPECT_TRUE(material().wireframe && viewer.take_redraw());
    press(Key::f);
    EXPECT_TRUE(!material().wireframe && viewer.take_redraw());
}

TEST_F(ViewerTest, KeyHeldDownTogglesOnce) {
    press(Key::f);
    viewer.receive(KeyEvent{.key = Key::f, .pressed = true, .repeat = true});
    EXPECT_TRUE(material().wireframe);
}

TEST_F(ViewerTest, KeysOfTheDesktopAreNotTheViewers) {
    press(Key::f, {.super = true});
    press(Key::c, {.control = true});
    press(Key::escape, {.alt = true});
    EXPECT_FALSE(material().wireframe || viewer.take_screenshot_request() ||
                 viewer.wants_to_close());
}

TEST_F(ViewerTest, RequestsAreTakenOnce) {
    for (const Key key : {Key::c, Key::f12}) {
        press(key);
        EXPECT_TRUE(viewer.take_screenshot_request());
        EXPECT_FALSE(viewer.take_screenshot_request());
    }
    for (const Key key : {Key::h, Key::f1}) {
        press(key);
        EXPECT_TRUE(viewer.take_help_request());
        EXPECT_FALSE(viewer.take_help_request());
    }
}

TEST_F(ViewerTest, EscapeLetsGoOfTheMouseFirst) {
    press(Key::m);
    EXPECT_TRUE(viewer.wants_mouse());
    press(Key::escape);
    EXPECT_FALSE(viewer.wants_mouse() || viewer.wants_to_close());
    press(Key::escape);
    EXPECT_TRUE(viewer.wants_to_close());
}

TEST_F(ViewerTest, ClosingTheWindowEndsIt) {
    viewer.receive(CloseEvent{});
    EXPECT_TRUE(viewer.wants_to_close());
}

TEST_F(ViewerTest, MouseLookTurnsWithoutAButton) {
    const glm::dvec3 before = camera().target;
    viewer.receive(MouseMoveEvent{{10.0, 10.0}});
    press(Key::m);
    viewer.receive(MouseMoveEvent{{10.0, 10.0}});
    viewer.receive(MouseMoveEvent{{60.0, 10.0}});
    viewer.advance(frame);
    EXPECT_GT(camera().target.x, before.x);
}

TEST_F(ViewerTest, ResizeIsDrawnAnew) {
    viewer.take_redraw();
    viewer.receive(ResizeEvent{{500, 200}});
    EXPECT_TRUE(viewer.take_redraw());
}

TEST_F(ViewerTest, RGoesBackToTheFirstView) {
    const scene::Camera start = camera();
    for (const Key away : {Key::p, Key::o, Key::w}) {
        press(away);
        viewer.advance(frame);
        viewer.advance(2.0);
        EXPECT_NE(camera().eye, start.eye);
        press(Key::r);
        viewer.advance(1.0);
        EXPECT_EQ(camera().eye, start.eye);
        EXPECT_EQ(camera().projection, scene::ProjectionKind::perspective);
    }
}

TEST_F(ViewerTest, OShowsTheWholeMapAndComesBack) {
    const scene::Camera start = camera();
    press(Key::m);
    hold(Key::w);
    press(Key::o);
    EXPECT_EQ(camera().projection, scene::ProjectionKind::orthographic);
    EXPECT_FALSE(viewer.wants_mouse()) << "a map has no mouse look";
    EXPECT_FALSE(viewer.is_moving()) << "the key held before flew";
    for (const glm::dvec3 corner : {scene.bounds.low, scene.bounds.high}) {
        const auto pixel = scene::project(camera(), {400, 300}, corner).pixel;
        EXPECT_TRUE(pixel.x > 0.0 && pixel.x < 400.0 && pixel.y > 0.0 && pixel.y < 300.0);
    }
    press(Key::o);
    viewer.advance(1.0);
    EXPECT_EQ(camera().projection, scene::ProjectionKind::perspective);
    EXPECT_EQ(camera().eye, start.eye);
    EXPECT_EQ(camera().vertical_fov, start.vertical_fov);
}

TEST_F(ViewerTest, MapFollowsTheDraggingMouse) {
    press(Key::o);
    const auto under = [&](glm::dvec2 pixel) {
        return scene::view_ray(camera(), {400, 300}, pixel).origin;
    };
    const glm::dvec3 grabbed = under({200.0, 150.0});
    drag({200.0, 150.0}, {230.0, 130.0});
    viewer.advance(frame);
    EXPECT_LT(glm::distance(under({230.0, 130.0}), grabbed), 1e-6);
}

TEST_F(ViewerTest, MapGrowsAboutThePointer) {
    press(Key::o);
    const auto under = [&] { return scene::view_ray(camera(), {400, 300}, {120.0, 80.0}).origin; };
    viewer.receive(MouseMoveEvent{{120.0, 80.0}});
    const glm::dvec3 before = under();
    const double height = camera().view_height;
    viewer.receive(ScrollEvent{{0.0, 2.0}});
    viewer.advance(frame);
    EXPECT_NEAR(camera().view_height, height / 1.5625, 1e-9);
    EXPECT_LT(glm::distance(under(), before), 1e-6);
}

TEST_F(ViewerTest, MapIsNeverLost) {
    press(Key::o);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    const double height = camera().view_height;
    for (int i = 0; i < 5000; ++i) {
        viewer.receive(ScrollEvent{{0.0, 5.0 * any(random)}});
        drag({0.0, 0.0}, {1e4 * any(random), 1e4 * any(random)});
        viewer.advance(any(random));
        ASSERT_LE(glm::length(camera().target - scene.bounds.center()), 2.0 * 320.0);
        ASSERT_TRUE(camera().view_height <= 4.0 * height + 1e-6 &&
                    camera().view_height >= 0.9e-4 * height);
    }
    for (const double odd : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        viewer.receive(ScrollEvent{{0.0, odd}});
        drag({0.0, 0.0}, {odd, 1.0});
        viewer.advance(odd);
        EXPECT_TRUE(std::isfinite(glm::length(camera().target)));
        EXPECT_TRUE(std::isfinite(camera().view_height));
    }
}

TEST(Viewer, SceneThatBeginsAsAMapStaysOneUntilO) {
    session::SceneOptions map;
    map.projection = scene::ProjectionKind::orthographic;
    session::TerrainScene scene = hill_scene(map);
    const scene::Camera given = *scene.camera->get<scene::Camera>();
    Viewer viewer{scene, scene::orbit_path(scene.bounds), {400, 300}};
    EXPECT_TRUE(viewer.is_map());
    EXPECT_EQ(scene.camera->get<scene::Camera>()->view_height, given.view_height);
    viewer.receive(KeyEvent{.key = Key::o, .pressed = true});
    EXPECT_EQ(scene.camera->get<scene::Camera>()->projection, scene::ProjectionKind::perspective);
    EXPECT_TRUE(scene.scene.pick(scene::view_ray(scene.scene.camera(), {400, 300}, {200, 150})));
}

TEST_F(ViewerTest, TitleSaysWhatIsSeen) {
    view::FrameStats stats;
    stats.triangles = 2048;
    const std::string moving = viewer.title(stats, {20.0, 48.5});
    for (const char* part : {"hill", "polygons:lods=1", "48.5 fps", "20.0 ms", "2048 triangles"}) {
        EXPECT_THAT(moving, HasSubstr(part));
    }
    const std::string still = viewer.title(stats, {20.0, {}});
    EXPECT_THAT(still, Not(HasSubstr("fps")));
    EXPECT_THAT(still, HasSubstr("20.0 ms"));
}

TEST_F(ViewerTest, TitleSaysWhereTheEyeIs) {
    EXPECT_THAT(title(), HasSubstr("beside the terrain"));
    session::TerrainScene over = hill_scene(from({0.0, -80.0, 60.0}));
    const Viewer walker{over, scene::orbit_path(over.bounds), {400, 300}};
    EXPECT_THAT(walker.title({}, {}), HasSubstr("50 m above ground"));
    press(Key::o);
    EXPECT_THAT(title(), HasSubstr("map, 326 m high"));
}

TEST(Viewer, HelpNamesEveryKeyOnce) {
    const std::string keys = Viewer::keys();
    for (const char* name :
         {"W A S D", "Q E", "\n  P ", "\n  G ", "\n  O ", "\n  T, 1 2 ...", "\n  F ", "\n  M ",
          "\n  R, Home", "\n  C, F12", "\n  H, F1", "\n  Esc"}) {
        EXPECT_THAT(keys, HasSubstr(name));
    }
}

TEST(NextScreenshot, NeverTakesANameThatIsTaken) {
    const test::TemporaryFolder folder;
    EXPECT_EQ(next_screenshot(folder.path()).filename(), "reljef-0001.png");
    folder.write("reljef-0001.png", "x");
    folder.write("reljef-0003.png", "x");
    std::filesystem::create_symlink("nowhere", folder.path() / "reljef-0002.png");
    EXPECT_EQ(next_screenshot(folder.path()).filename(), "reljef-0004.png");
    folder.write("path-0001.gpx", "");
    EXPECT_EQ(next_stem(folder.path(), "path", {".toml", ".gpx"}).filename(), "path-0002")
        << "neither file is replaced";
}

} // namespace
} // namespace reljef::app
