#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/viewer.h"
#include "engine/io/image.h"
#include "tests/app/command_line.h"
#include "tests/support/temporary_folder.h"

namespace reljef::app {
namespace {

TerrainScene hill_scene() {
    TerrainSource source;
    source.terrain.name = "hill";
    auto& heightfield = source.terrain.heightfield;
    heightfield.heights = Grid<float>(33, 33, 10.0F);
    heightfield.heights(16, 16) = 60.0F;
    heightfield.spacing = {10.0, 10.0};
    heightfield.range = {10.0, 60.0};
    return make_scene(std::move(source), {}, {}).value();
}

class ViewerTest : public testing::Test {
protected:
    ViewerTest() : viewer_(scene_, scene::orbit_path(scene_.bounds, 10.0)) { viewer_.take_redraw(); }

    void press(Key key) {
        viewer_.receive(KeyEvent{.key = key, .pressed = true});
        viewer_.receive(KeyEvent{.key = key, .pressed = false});
    }
    scene::Camera camera() { return *scene_.camera->get<scene::Camera>(); }
    scene::Material& material() { return scene_.terrain->get<scene::TerrainNode>()->material; }

    TerrainScene scene_ = hill_scene();
    Viewer viewer_;
};

TEST_F(ViewerTest, a_still_viewer_draws_nothing) {
    for (int i = 0; i < 100; ++i) {
        viewer_.advance(0.016);
    }
    EXPECT_FALSE(viewer_.take_redraw());
    EXPECT_FALSE(viewer_.is_moving());
}

TEST_F(ViewerTest, held_key_moves_until_it_is_released) {
    const glm::dvec3 start = camera().eye;
    viewer_.receive(KeyEvent{.key = Key::w, .pressed = true});
    viewer_.advance(0.1);
    EXPECT_TRUE(viewer_.take_redraw());
    EXPECT_NE(camera().eye, start);
    viewer_.receive(KeyEvent{.key = Key::w, .pressed = false});
    viewer_.advance(0.1);
    EXPECT_FALSE(viewer_.take_redraw());
}

TEST_F(ViewerTest, never_under_the_ground) {
    viewer_.receive(KeyEvent{.key = Key::q, .pressed = true});
    viewer_.receive(KeyEvent{.key = Key::w, .pressed = true});
    for (int i = 0; i < 2000; ++i) {
        viewer_.advance(0.05);
        const auto ground = scene_.scene.height_at(camera().eye.x, camera().eye.y);
        ASSERT_TRUE(!ground || camera().eye.z > *ground);
    }
}

TEST_F(ViewerTest, p_flies_the_path_and_stops) {
    press(Key::p);
    EXPECT_TRUE(viewer_.is_playing());
    viewer_.advance(1.0);
    const glm::dvec3 flying = camera().eye;
    viewer_.advance(1.0);
    EXPECT_NE(camera().eye, flying);
    press(Key::p);
    viewer_.take_redraw();
    viewer_.advance(1.0);
    EXPECT_FALSE(viewer_.take_redraw());
}

TEST_F(ViewerTest, time_that_is_no_time_changes_nothing) {
    press(Key::p);
    for (const double seconds : {0.0, -5.0, 1e9, std::nan(""), HUGE_VAL}) {
        viewer_.advance(seconds);
        EXPECT_TRUE(std::isfinite(camera().eye.x));
    }
}

TEST_F(ViewerTest, t_and_digits_switch_techniques) {
    const auto first = material().technique.id;
    press(Key::t);
    EXPECT_NE(material().technique.id, first);
    EXPECT_TRUE(viewer_.take_redraw());
    press(Key::digit1);
    EXPECT_EQ(material().technique.id, scene::technique_catalogue()[0].id);
    viewer_.take_redraw();
    press(Key::digit9);
    EXPECT_FALSE(viewer_.take_redraw());
}

TEST_F(ViewerTest, o_shows_the_map_and_comes_back) {
    const glm::dvec3 start = camera().eye;
    press(Key::o);
    EXPECT_EQ(camera().projection, scene::ProjectionKind::orthographic);
    press(Key::o);
    EXPECT_EQ(camera().projection, scene::ProjectionKind::perspective);
    EXPECT_EQ(camera().eye, start);
}

TEST_F(ViewerTest, escape_lets_go_of_the_mouse_first) {
    press(Key::m);
    EXPECT_TRUE(viewer_.wants_mouse());
    press(Key::escape);
    EXPECT_FALSE(viewer_.wants_mouse());
    EXPECT_FALSE(viewer_.wants_to_close());
    press(Key::escape);
    EXPECT_TRUE(viewer_.wants_to_close());
}

TEST_F(ViewerTest, title_says_what_is_seen) {
    render::FrameStats stats;
    stats.triangles = 2048;
    const std::string title = viewer_.title(stats, 20.0);
    EXPECT_THAT(title, testing::HasSubstr("hill"));
    EXPECT_THAT(title, testing::HasSubstr("50.0 fps"));
    EXPECT_THAT(title, testing::HasSubstr("2048 triangles"));
}

TEST(NextScreenshot, never_overwrites) {
    const test::TemporaryFolder folder;
    folder.write("reljef-0001.png", "x");
    EXPECT_EQ(next_screenshot(folder.path()).filename(), "reljef-0002.png");
}

TEST(ViewCommand, opens_a_window_and_closes_after_the_frames_asked_for) {
    if (!test::has_display()) {
        GTEST_SKIP() << "no display";
    }
    const auto result = test::reljef({"view", "natural", "--technique", "texture", "--size", "320x240",
                                      "--path", "orbit", "--frames", "5"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, testing::HasSubstr("fly along the path"));
}

TEST(ViewCommand, headless_context_is_refused) {
    test::expect_refusal(test::reljef({"view", "natural", "--context", "osmesa"}), 1,
                         {"osmesa", "window"});
}

// Drives the real window with keys, as a person would.
TEST(ViewCommand, keys_switch_technique_save_a_picture_and_end) {
    if (!test::has_display() || !std::filesystem::exists("/usr/bin/xdotool")) {
        GTEST_SKIP() << "no display or no xdotool";
    }
    const test::TemporaryFolder folder;
    const std::string script =
        "'" RELJEF_BINARY "' view natural --technique texture --size 320x240 & viewer=$!\n"
        "window=$(timeout 60 xdotool search --sync --onlyvisible --name '^reljef - natural' | head -n 1)\n"
        "for key in t c Escape; do sleep 1; xdotool key --window \"$window\" $key; done\n"
        "for i in $(seq 100); do kill -0 $viewer 2>/dev/null || break; sleep 0.3; done\n"
        "kill -9 $viewer 2>/dev/null && exit 9\n"
        "wait $viewer\n";
    test::ProgramOptions options;
    options.folder = folder.path();
    options.timeout = std::chrono::seconds(150);
    const auto result = test::run_program("/bin/bash", {"-c", script}, options);
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    const auto saved = io::read_image(folder.path() / "reljef-0001.png");
    ASSERT_TRUE(saved) << result.out;
    EXPECT_EQ(saved->cols(), 320);
}

} // namespace
} // namespace reljef::app
