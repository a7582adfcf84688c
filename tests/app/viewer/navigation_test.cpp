#include "app/viewer/navigation.h"

#include <cmath>
#include <filesystem>
#include <random>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/viewer/viewer.h"
#include "engine/scene/graph/ground_pick.h"
#include "engine/session/ground.h"
#include "tests/app/made_hill.h"
#include "tests/support/temporary_folder.h"

namespace reljef::app {
namespace {

using testing::HasSubstr;

constexpr glm::ivec2 window_size{400, 300};
constexpr double tick = 1.0 / 60.0;
constexpr glm::dvec2 low_in_picture{180.0, 220.0}; // shows the ground

session::SceneOptions oblique() {
    session::SceneOptions view;
    view.eye = glm::dvec3(0.0, -300.0, 200.0);
    view.target = glm::dvec3(0.0, 0.0, 10.0);
    view.size = window_size;
    return view;
}

struct NavigationTest : testing::Test {
    void move(glm::dvec2 to) { viewer.receive(MouseMoveEvent{to}); }
    void button(MouseButton which, bool pressed, glm::dvec2 at, int clicks = 1) {
        viewer.receive(MouseButtonEvent{
            .button = which, .pressed = pressed, .position = at, .clicks = clicks});
    }
    void drag(MouseButton which, glm::dvec2 from, glm::dvec2 to) {
        move(from);
        button(which, true, from);
        for (int step = 1; step <= 10; ++step) {
            move(from + 0.1 * step * (to - from));
        }
        button(which, false, to);
        viewer.advance(tick);
    }
    scene::Camera camera() { return *scene.camera->get<scene::Camera>(); }
    std::optional<glm::dvec3> ground(glm::dvec2 pixel) {
        const auto hit = scene::pick_ground(*scene.terrain->get<scene::TerrainNode>(),
                                            scene::view_ray(camera(), window_size, pixel));
        return hit ? std::optional(hit->world) : std::nullopt;
    }
    double pixels_from(glm::dvec3 point, glm::dvec2 pixel) {
        return glm::distance(scene::project(camera(), window_size, point).pixel, pixel);
    }
    void press(Key key, Modifiers modifiers = {}) {
        viewer.receive(KeyEvent{.key = key, .pressed = true, .modifiers = modifiers});
        viewer.receive(KeyEvent{.key = key, .pressed = false, .modifiers = modifiers});
    }
    std::string notes() {
        struct Notes : session::Log {
            void message(session::MessageKind, std::string_view sentence) override {
                text += std::string(sentence) + '\n';
            }
            std::string text;
        } log;
        viewer.relay_to(log);
        return log.text;
    }

    test::TemporaryFolder folder;
    session::TerrainScene scene = hill_scene(oblique());
    Viewer viewer{
        scene,
        scene::orbit_path(scene.bounds, 10.0),
        window_size,
        {.maps = {}, .terrain = "hill.tif", .bookmarks = folder.path() / "data" / "bookmarks.txt"}};
};

TEST_F(NavigationTest, RightDragKeepsTheGrabbedGroundUnderThePointer) {
    const glm::dvec3 grabbed = *ground(low_in_picture);
    const double height = camera().eye.z;
    drag(MouseButton::right, low_in_picture, {260.0, 180.0});
    EXPECT_LT(pixels_from(grabbed, {260.0, 180.0}), 1.0);
    EXPECT_NEAR(camera().eye.z, height, 1e-6);
}

TEST_F(NavigationTest, PanIntoTheSkyStopsAndComesBack) {
    const glm::dvec3 grabbed = *ground(low_in_picture);
    move(low_in_picture);
    button(MouseButton::right, true, low_in_picture);
    move({200.0, 200.0});
    const scene::Camera before = camera();
    move({200.0, -2000.0});
    EXPECT_EQ(camera().eye, before.eye);
    move({210.0, 190.0});
    EXPECT_LT(pixels_from(grabbed, {210.0, 190.0}), 1.0);
}

TEST_F(NavigationTest, LeftDragOrbitsAroundTheGroundUnderThePointer) {
    const glm::dvec3 center = *ground(low_in_picture);
    const double distance = glm::distance(camera().eye, center);
    const glm::dvec3 before = camera().eye;
    drag(MouseButton::left, low_in_picture, {280.0, 200.0});
    EXPECT_LT(pixels_from(center, low_in_picture), 1.0);
    EXPECT_NEAR(glm::distance(camera().eye, center), distance, 1e-6);
    EXPECT_GT(glm::distance(camera().eye, before), 50.0);
}

TEST_F(NavigationTest, MiddleDragAndLeftDragFromTheSkyTurnInPlace) {
    const glm::dvec3 eye = camera().eye;
    for (const auto& [button, from] : {std::pair(MouseButton::middle, low_in_picture),
                                       std::pair(MouseButton::left, glm::dvec2(200.0, 1.0))}) {
        ASSERT_EQ(ground(from).has_value(), button == MouseButton::middle);
        const glm::dvec3 before = scene::view_axes(camera()).forward;
        drag(button, from, from + glm::dvec2(30.0, 0.0));
        EXPECT_EQ(camera().eye, eye);
        EXPECT_GT(glm::distance(scene::view_axes(camera()).forward, before), 0.05);
    }
}

// A tower that hides the hill's top from the eye.
TEST_F(NavigationTest, GesturesMeetObjectsBeforeTheGround) {
    scene.scene.root()
        .add("tower",
             scene::MeshNode{
                 std::make_shared<const scene::Mesh>(scene::box_mesh({20.0F, 20.0F, 60.0F})), {}})
        .set_position({0.0, -100.0, 40.0});
    const glm::dvec3 on_tower(2.0, -110.0, 55.0);
    const glm::dvec2 pixel = scene::project(camera(), window_size, on_tower).pixel;
    const auto picked = viewer.place_at_pixel(pixel);
    ASSERT_TRUE(picked);
    EXPECT_EQ(picked->object, "tower");
    EXPECT_LT(glm::distance(picked->world, on_tower), 1e-9);
    const double distance = glm::distance(camera().eye, on_tower);
    drag(MouseButton::left, pixel, pixel + glm::dvec2(60.0, 0.0));
    EXPECT_LT(pixels_from(on_tower, pixel), 1.0);
    EXPECT_NEAR(glm::distance(camera().eye, on_tower), distance, 1e-6) << "orbited";
    button(MouseButton::left, true, pixel, 2);
    button(MouseButton::left, false, pixel);
    viewer.advance(tick);
    viewer.advance(1.0);
    EXPECT_NEAR(glm::distance(camera().eye, on_tower), 0.25 * distance, 1e-6) << "flown to";
}

TEST_F(NavigationTest, WheelZoomsAtThePointer) {
    move(low_in_picture);
    const glm::dvec3 point = *ground(low_in_picture);
    const double distance = glm::distance(camera().eye, point);
    viewer.receive(ScrollEvent{{0.0, 2.0}});
    EXPECT_LT(pixels_from(point, low_in_picture), 1.0);
    EXPECT_NEAR(glm::distance(camera().eye, point), 0.64 * distance, 1e-6);
    viewer.receive(ScrollEvent{{0.0, -2.0}});
    EXPECT_NEAR(glm::distance(camera().eye, point), distance, 1e-6);
}

TEST_F(NavigationTest, WheelWithControlChangesTheSpeedOnly) {
    const scene::Camera before = camera();
    const std::string title = viewer.title({}, {});
    viewer.receive(ScrollEvent{{0.0, 2.0}, {.control = true}});
    EXPECT_EQ(camera().eye, before.eye);
    EXPECT_NE(viewer.title({}, {}), title);
}

TEST_F(NavigationTest, WheelInTheSkyMovesAheadAndBack) {
    move({200.0, 1.0});
    const glm::dvec3 before = camera().eye;
    viewer.receive(ScrollEvent{{0.0, 1.0}});
    EXPECT_GT(glm::dot(camera().eye - before, scene::view_axes(camera()).forward), 10.0);
}

TEST_F(NavigationTest, DoubleClickFliesThereSmoothly) {
    const glm::dvec3 point = *ground(low_in_picture);
    const double distance = glm::distance(camera().eye, point);
    button(MouseButton::left, true, low_in_picture);
    button(MouseButton::left, false, low_in_picture);
    button(MouseButton::left, true, low_in_picture, 2);
    button(MouseButton::left, false, low_in_picture);
    EXPECT_TRUE(viewer.is_moving());
    double last = distance;
    for (int step = 0; step < 80; ++step) {
        viewer.advance(tick);
        const double now = glm::distance(camera().eye, point);
        ASSERT_LT(last - now, 0.1 * distance) << "no leap";
        last = now;
    }
    EXPECT_NEAR(last, 0.25 * distance, 1e-6);
    EXPECT_LT(pixels_from(point, 0.5 * glm::dvec2(window_size)), 1.0);
    viewer.advance(1.0);
    EXPECT_FALSE(viewer.is_moving());
}

TEST_F(NavigationTest, KeysAndGesturesEndAFlight) {
    for (const bool by_key : {true, false}) {
        button(MouseButton::left, true, low_in_picture, 2);
        button(MouseButton::left, false, low_in_picture);
        viewer.advance(tick);
        by_key ? press(Key::e) : drag(MouseButton::right, low_in_picture, {190.0, 220.0});
        viewer.advance(tick);
        viewer.advance(1.0);
        const glm::dvec3 eye = camera().eye;
        viewer.advance(1.0);
        EXPECT_EQ(camera().eye, eye);
    }
}

TEST_F(NavigationTest, RandomGesturesStayAboveTheGround) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    const auto pixel = [&] {
        return glm::dvec2(200.0 + 220.0 * any(random), 150.0 + 170.0 * any(random));
    };
    const auto& terrain = *scene.terrain->get<scene::TerrainNode>();
    for (int i = 0; i < 3000; ++i) {
        switch (i % 5) {
        case 0:
            drag(MouseButton::left, pixel(), pixel());
            break;
        case 1:
            drag(MouseButton::right, pixel(), pixel());
            break;
        case 2:
            drag(MouseButton::middle, pixel(), pixel());
            break;
        case 3:
            viewer.receive(ScrollEvent{{0.0, 8.0 * any(random)}});
            break;
        default:
            button(MouseButton::left, true, pixel(), 2);
            viewer.advance(0.2);
        }
        const auto height = session::height_above_ground(terrain, camera().eye);
        ASSERT_TRUE(!height || *height > 0.1) << i;
        ASSERT_TRUE(std::isfinite(glm::length(camera().eye + camera().target))) << i;
        ASSERT_LT(glm::length(camera().eye), 50.0 * 320.0) << i;
    }
}

TEST_F(NavigationTest, ClickWhileMeasuringPicksAPointAlsoOnTheMap) {
    const auto click = [&] {
        move(low_in_picture);
        button(MouseButton::left, true, low_in_picture);
        move(low_in_picture + glm::dvec2(1.0, 0.0));
        button(MouseButton::left, false, low_in_picture);
    };
    click();
    EXPECT_EQ(viewer.take_output(), "");
    press(Key::x);
    click();
    EXPECT_THAT(viewer.take_output(), HasSubstr("1  x "));
    press(Key::o);
    click();
    EXPECT_THAT(viewer.take_output(), HasSubstr("\n  distance "));
    press(Key::o);
    drag(MouseButton::left, low_in_picture, {280.0, 200.0});
    EXPECT_EQ(viewer.take_output(), "") << "a drag is no click";
    press(Key::x);
    click();
    EXPECT_THAT(viewer.take_output(), testing::Not(HasSubstr("3  x ")));
    EXPECT_EQ(viewer.measuring().points().size(), 2U);
}

TEST_F(NavigationTest, KeysRecordAndEditThePath) {
    const auto temporary = std::filesystem::current_path();
    std::filesystem::current_path(folder.path());
    press(Key::k);
    EXPECT_TRUE(viewer.path_desk().is_recording());
    viewer.receive(KeyEvent{.key = Key::w, .pressed = true});
    for (int i = 0; i < 60; ++i) {
        viewer.advance(tick);
    }
    viewer.receive(KeyEvent{.key = Key::w, .pressed = false});
    press(Key::k);
    EXPECT_THAT(viewer.take_output(), HasSubstr("saved reljef-path-0001.toml"));
    EXPECT_NEAR(viewer.path_desk().path().duration(), 59.0 / 60.0, 1e-6);
    const std::size_t keys = viewer.path_desk().path().keys().size();
    press(Key::insert);
    EXPECT_EQ(viewer.path_desk().path().keys().size(), keys + 1);
    press(Key::erase);
    EXPECT_EQ(viewer.path_desk().path().keys().size(), keys);
    viewer.seek(viewer.path_desk().path().duration());
    EXPECT_LT(glm::distance(camera().eye, viewer.path_desk().path().keys().back().eye), 1e-6);
    viewer.seek(0.5);
    EXPECT_LT(glm::distance(camera().eye, viewer.path_desk().path().at(0.5).eye), 1e-6);
    press(Key::j);
    EXPECT_TRUE(std::filesystem::exists("reljef-path-0002.toml"));
    press(Key::i);
    EXPECT_THAT(notes(), HasSubstr("X measures"));
    press(Key::y);
    EXPECT_TRUE(viewer.take_video_request());
    press(Key::o);
    press(Key::y);
    EXPECT_TRUE(viewer.take_video_request());
    EXPECT_EQ(camera().projection, scene::ProjectionKind::perspective) << "the map is no flight";
    std::filesystem::current_path(temporary);
}

TEST_F(NavigationTest, CopiedCameraShowsTheSameView) {
    press(Key::c, {.control = true});
    const auto text = viewer.take_clipboard();
    ASSERT_TRUE(text);
    EXPECT_THAT(*text, testing::StartsWith("--eye 0.0000,-300.0000,200.0000 --look "));
    EXPECT_THAT(viewer.take_output(), HasSubstr(*text));
    press(Key::o);
    press(Key::v);
    EXPECT_FALSE(viewer.take_clipboard());
    EXPECT_THAT(notes(), HasSubstr("the map has no --camera"));
}

TEST_F(NavigationTest, BookmarksAreKeptListedAndFlownTo) {
    press(Key::n);
    EXPECT_THAT(notes(), HasSubstr("no bookmark; B makes one"));
    const scene::Camera first = camera();
    press(Key::b);
    drag(MouseButton::right, low_in_picture, {100.0, 250.0});
    const scene::Camera second = camera();
    ASSERT_TRUE(viewer.save_bookmark("ridge"));
    ASSERT_EQ(viewer.bookmarks()->bookmarks.size(), 2U);
    EXPECT_EQ(viewer.bookmarks()->bookmarks[1].name, "ridge");
    for (const scene::Camera& there : {first, second, first}) {
        press(Key::n);
        for (int i = 0; i < 20; ++i) {
            viewer.advance(0.1);
        }
        EXPECT_LT(glm::distance(camera().eye, there.eye), 1e-3);
        EXPECT_LT(
            glm::distance(scene::view_axes(camera()).forward, scene::view_axes(there).forward),
            1e-5);
    }
    EXPECT_EQ(notes(), "");
    ASSERT_TRUE(viewer.remove_bookmark(viewer.bookmarks()->bookmarks[0]));
    EXPECT_EQ(viewer.bookmarks()->bookmarks.size(), 1U);
}

TEST_F(NavigationTest, BookmarkOfNoPlaceIsANote) {
    folder.write("data/bookmarks.txt", "hill.tif\tAlps\t--camera 46,8,2000,0,0\n");
    press(Key::n);
    EXPECT_THAT(notes(), HasSubstr("bookmark Alps: --camera 46,8,2000,0,0 found, a place of this"));
}

TEST(ClickCounter, CountsTwoClosePressesAsADoubleClick) {
    ClickCounter clicks;
    EXPECT_EQ(clicks.press(MouseButton::left, {10.0, 10.0}, 1.0), 1);
    EXPECT_EQ(clicks.press(MouseButton::left, {11.0, 10.0}, 1.2), 2);
    EXPECT_EQ(clicks.press(MouseButton::left, {11.0, 10.0}, 1.4), 1) << "a third";
    EXPECT_EQ(clicks.press(MouseButton::right, {11.0, 10.0}, 1.5), 1) << "another button";
    EXPECT_EQ(clicks.press(MouseButton::right, {51.0, 10.0}, 1.6), 1) << "another place";
    EXPECT_EQ(clicks.press(MouseButton::right, {51.0, 10.0}, 2.6), 1) << "too late";
}

} // namespace
} // namespace reljef::app
