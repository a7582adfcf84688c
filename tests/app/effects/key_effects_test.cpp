// Each key that the viewer lists has its effect. A key without a row here fails the test.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/viewer/panels/panels.h"
#include "app/viewer/viewer_content.h"
#include "tests/app/effects/keyed_viewer.h"
#include "tests/scene/technique/terrain_techniques.h"
#include "tests/session/made_waves.h"
#include "tests/support/temporary_folder.h"

namespace reljef::app {
namespace {

using testing::HasSubstr;

struct KeyCase {
    std::string_view names; // as the viewer lists them
    void (*check)(KeyedViewer&);
};

void check_wheel(KeyedViewer& keyed) {
    const glm::dvec3 before = keyed.camera().eye;
    keyed.viewer.receive(MouseMoveEvent{on_ground_in_picture});
    keyed.viewer.receive(ScrollEvent{{0.0, 1.0}});
    EXPECT_GT(glm::dot(keyed.camera().eye - before, keyed.forward()), 1.0);
}

void check_left_drag(KeyedViewer& keyed) {
    const auto place = keyed.viewer.place_at_pixel(on_ground_in_picture);
    ASSERT_TRUE(place);
    const double distance = glm::distance(keyed.camera().eye, place->world);
    const glm::dvec3 before = keyed.camera().eye;
    keyed.drag(MouseButton::left, {60.0, 0.0});
    EXPECT_GT(glm::distance(keyed.camera().eye, before), 10.0);
    EXPECT_NEAR(glm::distance(keyed.camera().eye, place->world), distance, 1e-6);
}

void check_right_drag(KeyedViewer& keyed) {
    const scene::Camera before = keyed.camera();
    keyed.drag(MouseButton::right, {60.0, -20.0});
    EXPECT_GT(glm::distance(keyed.camera().eye, before.eye), 10.0);
    EXPECT_NEAR(keyed.camera().eye.z, before.eye.z, 1e-6);
}

void check_middle_drag(KeyedViewer& keyed) {
    const glm::dvec3 eye = keyed.camera().eye;
    const glm::dvec3 forward = keyed.forward();
    keyed.drag(MouseButton::middle, {60.0, 0.0});
    EXPECT_EQ(keyed.camera().eye, eye);
    EXPECT_GT(glm::distance(keyed.forward(), forward), 0.05);
}

void check_double_click(KeyedViewer& keyed) {
    keyed.viewer.receive(MouseButtonEvent{
        .pressed = true, .position = on_ground_in_picture, .modifiers = {}, .clicks = 2});
    EXPECT_TRUE(keyed.viewer.is_moving());
}

void check_moves(KeyedViewer& keyed) {
    for (const Key key : {Key::w, Key::up}) {
        EXPECT_GT(keyed.way_of(key).y, 0.0);
    }
    for (const Key key : {Key::s, Key::down}) {
        EXPECT_LT(keyed.way_of(key).y, 0.0);
    }
    for (const Key key : {Key::d, Key::right}) {
        EXPECT_GT(keyed.way_of(key).x, 0.0);
    }
    for (const Key key : {Key::a, Key::left}) {
        EXPECT_LT(keyed.way_of(key).x, 0.0);
    }
    const double slow = keyed.way_of(Key::d).x;
    keyed.viewer.receive(KeyEvent{.key = Key::shift, .pressed = true});
    EXPECT_GT(keyed.way_of(Key::d, {.shift = true}).x, 2.0 * slow);
    keyed.viewer.receive(KeyEvent{.key = Key::shift, .pressed = false});
    const double speed = keyed.viewer.speed();
    keyed.viewer.receive(ScrollEvent{{0.0, 1.0}, {.control = true}});
    EXPECT_GT(keyed.viewer.speed(), speed);
}

void check_up_and_down(KeyedViewer& keyed) {
    for (const Key key : {Key::e, Key::page_up}) {
        EXPECT_GT(keyed.way_of(key).z, 0.0);
    }
    for (const Key key : {Key::q, Key::page_down}) {
        EXPECT_LT(keyed.way_of(key).z, 0.0);
    }
}

void check_path(KeyedViewer& keyed) {
    keyed.press(Key::p);
    EXPECT_TRUE(keyed.viewer.is_playing());
    keyed.press(Key::p);
    EXPECT_FALSE(keyed.viewer.is_playing());
}

// Ahead over the hill, the eye rises with it only if it keeps its height.
void check_follows_ground(KeyedViewer& keyed) {
    const bool before = keyed.viewer.follows_ground();
    keyed.press(Key::g);
    EXPECT_NE(keyed.viewer.follows_ground(), before);
    keyed.press(Key::g);
    EXPECT_EQ(keyed.viewer.follows_ground(), before);
}

void check_map(KeyedViewer& keyed) {
    keyed.press(Key::o);
    EXPECT_EQ(keyed.camera().projection, scene::ProjectionKind::orthographic);
    keyed.press(Key::o);
    EXPECT_EQ(keyed.camera().projection, scene::ProjectionKind::perspective);
}

void check_techniques(KeyedViewer& keyed) {
    const auto before = keyed.viewer.technique().id();
    keyed.press(Key::t);
    EXPECT_NE(keyed.viewer.technique().id(), before);
    keyed.press(Key::digit1);
    EXPECT_EQ(keyed.viewer.technique().id(), scene::terrain_techniques().front().id);
    keyed.press(Key::digit2);
    EXPECT_EQ(keyed.viewer.technique().id(), scene::terrain_techniques()[1].id);
}

void check_parameter_up(KeyedViewer& keyed) {
    keyed.choose_relief();
    const int before = keyed.relief().linear_steps;
    keyed.press(Key::right_bracket);
    EXPECT_EQ(keyed.relief().linear_steps, before + 1);
}

void check_parameter_down(KeyedViewer& keyed) {
    keyed.choose_relief();
    const int before = keyed.relief().linear_steps;
    keyed.press(Key::left_bracket);
    EXPECT_EQ(keyed.relief().linear_steps, before - 1);
}

void check_next_parameter(KeyedViewer& keyed) {
    keyed.choose_relief();
    const scene::Relief before = keyed.relief();
    keyed.press(Key::period);
    keyed.press(Key::right_bracket);
    EXPECT_EQ(keyed.relief().linear_steps, before.linear_steps);
    EXPECT_EQ(keyed.relief().bisection_steps, before.bisection_steps + 1);
    EXPECT_TRUE(keyed.viewer.take_content_change()) << "the panel marks it";
}

void check_last_parameter(KeyedViewer& keyed) {
    keyed.choose_relief();
    keyed.press(Key::period);
    keyed.press(Key::comma);
    const int before = keyed.relief().linear_steps;
    keyed.press(Key::right_bracket);
    EXPECT_EQ(keyed.relief().linear_steps, before + 1);
}

void check_light(KeyedViewer& keyed) {
    const scene::Light before = keyed.viewer.light();
    keyed.press(Key::l);
    EXPECT_NEAR(std::fmod(keyed.viewer.light().azimuth - before.azimuth + 360.0, 360.0), 15.0,
                1e-9);
    keyed.settle();
    EXPECT_EQ(keyed.scene.light->get<scene::Light>()->azimuth, keyed.viewer.light().azimuth);
}

void check_wireframe(KeyedViewer& keyed) {
    keyed.press(Key::f);
    EXPECT_TRUE(keyed.scene.materials().front()->wireframe);
}

void check_mouse_look(KeyedViewer& keyed) {
    keyed.press(Key::m);
    EXPECT_TRUE(keyed.viewer.wants_mouse());
    keyed.press(Key::m);
    EXPECT_FALSE(keyed.viewer.wants_mouse());
}

void check_back_to_start(KeyedViewer& keyed) {
    const glm::dvec3 start = keyed.camera().eye;
    for (const Key key : {Key::r, Key::home}) {
        EXPECT_GT(keyed.way_of(Key::d).x, 0.0);
        keyed.press(key);
        EXPECT_EQ(keyed.camera().eye, start);
    }
}

void check_bookmark(KeyedViewer& keyed) {
    keyed.press(Key::b);
    EXPECT_EQ(keyed.viewer.bookmarks()->bookmarks.size(), 1U);
    EXPECT_THAT(keyed.viewer.take_output(), HasSubstr("bookmark view 1"));
}

void check_first_techniques(KeyedViewer& keyed) {
    const scene::Technique first = keyed.viewer.technique();
    keyed.choose_relief();
    keyed.settle();
    EXPECT_NE(keyed.viewer.technique(), first);
    keyed.press(Key::digit0);
    keyed.settle();
    EXPECT_EQ(keyed.viewer.technique(), first);
}

// See also AViewshedIsSavedFromTheLastPoint.
void check_viewshed_colours(KeyedViewer& keyed) {
    keyed.press(Key::f2);
    EXPECT_FALSE(keyed.viewer.shows_viewshed());
    EXPECT_THAT(keyed.notes(), HasSubstr("U makes it"));
}

void check_next_bookmark(KeyedViewer& keyed) {
    const glm::dvec3 marked = keyed.camera().eye;
    keyed.press(Key::b);
    EXPECT_GT(keyed.way_of(Key::d).x, 0.0);
    keyed.press(Key::n);
    for (int i = 0; i < 20; ++i) {
        keyed.viewer.advance(0.1);
    }
    EXPECT_LT(glm::distance(keyed.camera().eye, marked), 1e-3);
}

void check_copied_camera(KeyedViewer& keyed) {
    for (const Modifiers with : {Modifiers{}, Modifiers{.control = true}}) {
        keyed.press(with.control ? Key::c : Key::v, with);
        const auto copied = keyed.viewer.take_clipboard();
        ASSERT_TRUE(copied);
        EXPECT_THAT(*copied, testing::StartsWith("--eye 0.0000,-300.0000,200.0000"));
    }
    EXPECT_FALSE(keyed.viewer.take_screenshot_request()) << "Ctrl-C is no C";
}

void check_measuring(KeyedViewer& keyed) {
    keyed.press(Key::x);
    keyed.click();
    EXPECT_EQ(keyed.viewer.measuring().points().size(), 1U);
    keyed.press(Key::x);
    keyed.click();
    EXPECT_EQ(keyed.viewer.measuring().points().size(), 1U);
}

void check_profile(KeyedViewer& keyed) {
    keyed.press(Key::i);
    EXPECT_FALSE(KeyedViewer::has_file("reljef-profile-0001.csv"));
    EXPECT_THAT(keyed.notes(), HasSubstr("X measures"));
    keyed.press(Key::x);
    keyed.click();
    keyed.viewer.receive(MouseMoveEvent{{250.0, 200.0}});
    keyed.viewer.receive(MouseButtonEvent{.pressed = true, .position = {250.0, 200.0}});
    keyed.viewer.receive(MouseButtonEvent{.pressed = false, .position = {250.0, 200.0}});
    keyed.press(Key::i);
    EXPECT_TRUE(KeyedViewer::has_file("reljef-profile-0001.csv"));
    EXPECT_EQ(keyed.notes(), "");
}

// See also AViewshedIsSavedFromTheLastPoint.
void check_viewshed(KeyedViewer& keyed) {
    keyed.press(Key::x);
    keyed.click();
    keyed.press(Key::u);
    EXPECT_THAT(keyed.notes(), HasSubstr("no place on Earth"));
}

void check_recording(KeyedViewer& keyed) {
    keyed.press(Key::k);
    EXPECT_TRUE(keyed.viewer.path_desk().is_recording());
    EXPECT_GT(keyed.way_of(Key::d).x, 0.0);
    keyed.press(Key::k);
    EXPECT_FALSE(keyed.viewer.path_desk().is_recording());
    EXPECT_TRUE(KeyedViewer::has_file("reljef-path-0001.toml"));
}

void check_append(KeyedViewer& keyed) {
    keyed.press(Key::insert);
    ASSERT_EQ(keyed.viewer.path_desk().path().keys().size(), 1U);
    EXPECT_EQ(keyed.viewer.path_desk().path().keys().front().eye, keyed.camera().eye);
    keyed.press(Key::insert);
    EXPECT_EQ(keyed.viewer.path_desk().path().keys().size(), 2U);
}

void check_remove(KeyedViewer& keyed) {
    keyed.press(Key::insert);
    keyed.press(Key::insert);
    keyed.press(Key::erase);
    EXPECT_EQ(keyed.viewer.path_desk().path().keys().size(), 1U);
    keyed.press(Key::erase);
    EXPECT_EQ(keyed.viewer.path_desk().path().keys().size(), 1U) << "the only one stays";
    EXPECT_NE(keyed.notes(), "");
}

void check_saved_path(KeyedViewer& keyed) {
    keyed.press(Key::j);
    EXPECT_TRUE(KeyedViewer::has_file("reljef-path-0001.toml"));
}

void check_video(KeyedViewer& keyed) {
    keyed.press(Key::y);
    EXPECT_TRUE(keyed.viewer.take_video_request());
}

void check_comparison(KeyedViewer& keyed) {
    keyed.press(Key::space);
    EXPECT_EQ(keyed.viewer.comparison().with(), CompareWith::truth);
    keyed.press(Key::space);
    EXPECT_EQ(keyed.viewer.comparison().with(), CompareWith::nothing);
}

void check_next_comparison(KeyedViewer& keyed) {
    for (const CompareWith with :
         {CompareWith::truth, CompareWith::errors, CompareWith::technique, CompareWith::truth}) {
        keyed.press(Key::enter);
        EXPECT_EQ(keyed.viewer.comparison().with(), with);
    }
}

void check_other_technique(KeyedViewer& keyed) {
    const auto before = keyed.viewer.comparison().technique();
    keyed.press(Key::backslash);
    EXPECT_NE(keyed.viewer.comparison().technique(), before);
    EXPECT_EQ(keyed.viewer.comparison().with(), CompareWith::technique);
}

void check_line(KeyedViewer& keyed) {
    keyed.press(Key::space);
    const double before = keyed.viewer.comparison().share();
    keyed.press(Key::minus);
    EXPECT_LT(keyed.viewer.comparison().share(), before);
    keyed.press(Key::plus);
    EXPECT_NEAR(keyed.viewer.comparison().share(), before, 1e-12);
    keyed.press(Key::plus);
    EXPECT_GT(keyed.viewer.comparison().share(), before);
}

void check_picture(KeyedViewer& keyed) {
    for (const Key key : {Key::c, Key::f12}) {
        keyed.press(key);
        EXPECT_TRUE(keyed.viewer.take_screenshot_request());
    }
}

void check_command(KeyedViewer& keyed) {
    keyed.press(Key::z);
    EXPECT_TRUE(keyed.viewer.take_command_request());
}

void check_help(KeyedViewer& keyed) {
    for (const Key key : {Key::h, Key::f1}) {
        keyed.press(key);
        EXPECT_TRUE(keyed.viewer.take_help_request());
    }
}

void check_end(KeyedViewer& keyed) {
    keyed.press(Key::m);
    keyed.press(Key::escape);
    EXPECT_FALSE(keyed.viewer.wants_mouse() || keyed.viewer.wants_to_close());
    keyed.press(Key::k);
    EXPECT_GT(keyed.way_of(Key::d).x, 0.0);
    keyed.press(Key::escape);
    EXPECT_FALSE(keyed.viewer.path_desk().is_recording() || keyed.viewer.wants_to_close());
    EXPECT_TRUE(KeyedViewer::has_file("reljef-path-0001.toml"));
    keyed.press(Key::escape);
    EXPECT_TRUE(keyed.viewer.wants_to_close());
}

void check_panels(KeyedViewer& /*keyed*/) {
    Panels panels{Interface::create({.draws = false}).value()};
    for (const bool is_shown : {false, true}) {
        EXPECT_TRUE(panels.receive(KeyEvent{.key = Key::tab, .pressed = true}));
        EXPECT_EQ(panels.is_visible(), is_shown);
    }
}

const std::vector<KeyCase>& key_cases() {
    static const std::vector<KeyCase> cases{{"wheel", check_wheel},
                                            {"left drag", check_left_drag},
                                            {"right drag", check_right_drag},
                                            {"middle drag", check_middle_drag},
                                            {"double click", check_double_click},
                                            {"W A S D, arrows", check_moves},
                                            {"Q E", check_up_and_down},
                                            {"P", check_path},
                                            {"G", check_follows_ground},
                                            {"O", check_map},
                                            {"T, 1 2 ...", check_techniques},
                                            {"0", check_first_techniques},
                                            {"]", check_parameter_up},
                                            {"[", check_parameter_down},
                                            {".", check_next_parameter},
                                            {",", check_last_parameter},
                                            {"L", check_light},
                                            {"F", check_wireframe},
                                            {"M", check_mouse_look},
                                            {"R, Home", check_back_to_start},
                                            {"B", check_bookmark},
                                            {"N", check_next_bookmark},
                                            {"V, Ctrl-C", check_copied_camera},
                                            {"X", check_measuring},
                                            {"I", check_profile},
                                            {"U", check_viewshed},
                                            {"F2", check_viewshed_colours},
                                            {"K", check_recording},
                                            {"Insert", check_append},
                                            {"Delete", check_remove},
                                            {"J", check_saved_path},
                                            {"Y", check_video},
                                            {"Space", check_comparison},
                                            {"Enter", check_next_comparison},
                                            {"\\", check_other_technique},
                                            {"-", check_line},
                                            {"+, =", check_line},
                                            {"C, F12", check_picture},
                                            {"Z", check_command},
                                            {"H, F1", check_help},
                                            {"Esc", check_end},
                                            {"Tab", check_panels}};
    return cases;
}

TEST(KeyEffects, EachListedKeyHasItsEffect) {
    for (const KeyContent& listed : Viewer::key_list()) {
        SCOPED_TRACE(listed.names + ": " + listed.meaning);
        const auto& cases = key_cases();
        const auto found = std::find_if(cases.begin(), cases.end(), [&](const KeyCase& key) {
            return key.names == listed.names;
        });
        if (found == cases.end()) {
            ADD_FAILURE() << "this key has no test";
            continue;
        }
        KeyedViewer keyed;
        found->check(keyed);
    }
}

TEST(KeyEffects, AViewshedIsSavedFromTheLastPoint) {
    const test::TemporaryFolder folder;
    const WorkingFolder in_folder(folder.path());
    test::write_waves("waves.tif", 60, 40);
    session::SourceOptions source;
    source.terrain = "waves.tif";
    session::Log silent;
    auto scene = session::open_scene(source, {}, silent);
    ASSERT_TRUE(scene) << scene.error().message;
    Viewer viewer{*scene, scene::orbit_path(scene->bounds, 10.0), keyed_window};
    const auto press = [&](Key key) {
        viewer.receive(KeyEvent{.key = key, .pressed = true});
        viewer.receive(KeyEvent{.key = key, .pressed = false});
    };
    press(Key::x);
    const glm::dvec2 middle = 0.5 * glm::dvec2(keyed_window);
    viewer.receive(MouseMoveEvent{middle});
    viewer.receive(MouseButtonEvent{.pressed = true, .position = middle});
    viewer.receive(MouseButtonEvent{.pressed = false, .position = middle});
    ASSERT_EQ(viewer.measuring().points().size(), 1U);
    press(Key::u);
    std::string output;
    for (int i = 0; i < 30'000 && output.find("viewshed") == std::string::npos; ++i) { // a minute
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        viewer.advance(keyed_step);
        output += viewer.take_output();
    }
    EXPECT_THAT(output, HasSubstr("reljef-viewshed-0001.tif"));
    EXPECT_TRUE(std::filesystem::exists("reljef-viewshed-0001.tif"));
    EXPECT_TRUE(viewer.shows_viewshed());
    press(Key::f2);
    EXPECT_FALSE(viewer.shows_viewshed());
    EXPECT_TRUE(content_of(viewer, *scene, keyed_window).measure.ground_colors.empty());
    press(Key::f2);
    EXPECT_TRUE(viewer.shows_viewshed());
    const auto colors = content_of(viewer, *scene, keyed_window).measure.ground_colors;
    ASSERT_EQ(colors.size(), 2U) << "in place of the legend of heights";
    EXPECT_EQ(colors[0].color, Measuring::visible_color);
    EXPECT_EQ(colors[1].color, Measuring::hidden_color);
}

} // namespace
} // namespace reljef::app
