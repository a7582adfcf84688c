#include <algorithm>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/viewer/viewer.h"
#include "engine/io/image/image.h"
#include "tests/app/command_line.h"
#include "tests/app/window/driven_window.h"
#include "tests/support/temporary_folder.h"

namespace reljef::app {
namespace {

using test::can_drive;
using test::drive;
using testing::HasSubstr;
using testing::Not;

TEST(ViewCommand, ContextWithoutAWindowIsRefused) {
    for (const std::string context : {"osmesa", "egl"}) {
        test::expect_refusal(test::reljef({"view", "natural", "--context", context}), 2,
                             {"--context", context, "window", "glfw"});
    }
}

TEST(ViewCommand, WithoutADisplayItSaysWhatElseThereIs) {
    test::ProgramOptions options;
    options.environment = {{"DISPLAY", std::nullopt}, {"WAYLAND_DISPLAY", std::nullopt}};
    test::expect_refusal(test::reljef({"view", "natural"}, options), 1,
                         {"no display", "reljef render"});
}

TEST(ViewCommand, HelpShowsTheKeysAndExamples) {
    const auto result = test::reljef({"view", "--help"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.out, HasSubstr(Viewer::keys()));
    EXPECT_THAT(result.out, HasSubstr("reljef view natural"));
}

TEST(ViewCommand, ClosesAfterTheFramesAskedForEvenWhereNothingMoves) {
    if (!test::has_display()) {
        GTEST_SKIP() << "no display";
    }
    const test::TemporaryFolder folder;
    const auto result = test::reljef({"view", test::small_terrain(folder, "natural"), "--technique",
                                      "texture", "--size", "320x240", "--frames", "3"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("fly along the path"));
}

TEST(ViewCommand, KeysOfARealWindowSwitchSaveResizeAndEnd) {
    if (!can_drive()) {
        GTEST_SKIP() << "no display or no xdotool";
    }
    const test::TemporaryFolder folder;
    const auto result = drive(folder, "titled 'texture - still'\n"
                                      "pressed c; until_true test -e reljef-0001.png\n"
                                      "pressed t; titled polygons; pressed 1; titled texture\n"
                                      "pressed p; titled fps; pressed p; titled still\n"
                                      "pressed o; titled map\n"
                                      "xdotool windowsize --sync $window 300 200\n"
                                      "pressed c; until_true test -e reljef-0002.png\n"
                                      "pressed Escape");
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    const auto flight = io::read_image(folder.path() / "reljef-0001.png");
    const auto map = io::read_image(folder.path() / "reljef-0002.png");
    ASSERT_TRUE(flight && map) << result.out << result.err;
    EXPECT_EQ(glm::ivec2(flight->cols(), flight->rows()), glm::ivec2(320, 240));
    EXPECT_EQ(glm::ivec2(map->cols(), map->rows()), glm::ivec2(300, 200));
    EXPECT_THAT(folder.names(), testing::ElementsAre("reljef-0001.png", "reljef-0002.png"));
}

TEST(ViewCommand, OutputThatIsLostHasItsOwnReason) {
    if (!test::has_display()) {
        GTEST_SKIP() << "no display";
    }
    const test::TemporaryFolder folder;
    const auto result = test::run_program(
        "/bin/sh", {"-c",
                    "exec '" RELJEF_BINARY "' view \"$0\" --frames 1 --size 320x240 --technique "
                    "texture >/dev/full",
                    test::small_terrain(folder, "natural")});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, HasSubstr("standard output: cannot be written: No space left"));
}

TEST(ViewCommand, OpenGlDrawsInTheSameWindowWhatRaysCannot) {
    if (!can_drive()) {
        GTEST_SKIP() << "no display or no xdotool";
    }
    const test::TemporaryFolder folder;
    const auto result = drive(folder,
                              "titled 'exact - still'; titled '76800 rays'\n"
                              "pressed c; until_true test -e reljef-0001.png\n"
                              "pressed 1; titled texture; titled triangles\n"
                              "pressed 2; titled 'polygons:error=1 - still'; titled '76800 rays'\n"
                              "pressed f; titled triangles; pressed f; titled rays\n"
                              "pressed p; titled fps; pressed p; titled still\n"
                              "xdotool windowsize --sync $window 300 200; titled '60000 rays'\n"
                              "pressed c; until_true test -e reljef-0002.png\n"
                              "pressed Escape",
                              "--context cpu");
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    EXPECT_THAT(result.err, HasSubstr("technique texture: drawn by OpenGL"));
    EXPECT_THAT(result.err, HasSubstr("rays on the CPU draw again"));
    EXPECT_THAT(result.err, HasSubstr("a wireframe: drawn by OpenGL"));
    const auto resized = io::read_image(folder.path() / "reljef-0002.png");
    ASSERT_TRUE(resized) << result.out << result.err;
    EXPECT_EQ(glm::ivec2(resized->cols(), resized->rows()), glm::ivec2(300, 200));
}

TEST(ViewCommand, MouseOfARealWindowPansZoomsAndMeasures) {
    if (!can_drive()) {
        GTEST_SKIP() << "no display or no xdotool";
    }
    const test::TemporaryFolder folder;
    const auto result =
        drive(folder,
              "export at='xdotool mousemove --window '$window\n"
              "titled 'texture - still'; pressed c; until_true test -e reljef-0001.png\n"
              "$at 160 140 mousedown 3; $at 170 135; $at 190 150; xdotool mouseup 3\n"
              "titled still; pressed c; until_true test -e reljef-0002.png\n"
              "$at 160 140 click 4 click 4; titled still\n"
              "pressed c; until_true test -e reljef-0003.png\n"
              "pressed x; $at 140 140 click 1; $at 190 150 click 1\n"
              "pressed i; until_true test -e reljef-profile-0001.csv\n"
              "pressed b; until_true test -e data/reljef/bookmarks.txt\n"
              "pressed Escape",
              "--technique texture --no-panels");
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    const auto first = io::read_image(folder.path() / "reljef-0001.png");
    const auto panned = io::read_image(folder.path() / "reljef-0002.png");
    const auto zoomed = io::read_image(folder.path() / "reljef-0003.png");
    ASSERT_TRUE(first && panned && zoomed) << result.out << result.err;
    EXPECT_NE(*first, *panned);
    EXPECT_NE(*panned, *zoomed);
    EXPECT_THAT(result.out, HasSubstr("\n2  x "));
    EXPECT_THAT(result.out, HasSubstr("over the ground"));
    EXPECT_THAT(result.err, Not(HasSubstr("reljef: ")));
}

TEST(ViewCommand, PathOfARealWindowBecomesAVideoOrIsCancelled) {
    if (!can_drive() || !std::filesystem::exists("/usr/bin/ffmpeg")) {
        GTEST_SKIP() << "no display, no xdotool or no ffmpeg";
    }
    const test::TemporaryFolder folder;
    const auto result =
        drive(folder, "titled 'texture - still'; pressed Insert; xdotool click 5 click 5\n"
                      "pressed y; sleep 0.5; pressed Insert; pressed y; titled 'video'\n"
                      "until_true test -s reljef-0001.mp4; titled still\n"
                      "pressed y; titled 'video'; pressed Escape; titled still\n"
                      "pressed j; until_true test -e reljef-path-0001.toml; pressed Escape");
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    EXPECT_THAT(result.err, HasSubstr("a path with one keyframe found"));
    EXPECT_THAT(result.err, HasSubstr("the video is cancelled, nothing is saved"));
    EXPECT_THAT(folder.names(), testing::ElementsAre("reljef-0001.mp4", "reljef-path-0001.toml"));
}

// Rays draw both, so that the pictures have the same bits.
TEST(ViewCommand, TheCopiedCommandRendersWhatTheWindowShows) {
    if (!can_drive()) {
        GTEST_SKIP() << "no display or no xdotool";
    }
    const test::TemporaryFolder folder;
    const auto result = drive(folder,
                              "is_lit() { ! has_title ' %)'; }\n"
                              "titled 'exact - still'; pressed l; pressed bracketright\n"
                              "pressed w; sleep 2; until_true is_lit; titled still\n"
                              "pressed z; titled still\n"
                              "pressed c; until_true test -e reljef-0001.png\n"
                              "pressed Escape",
                              "--context cpu");
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    const auto begin = result.out.find("reljef render");
    ASSERT_NE(begin, std::string::npos) << result.out;
    const std::string command = result.out.substr(begin, result.out.find('\n', begin) - begin);
    test::ProgramOptions options;
    options.folder = folder.path();
    const auto rendered = test::run_program(
        "/bin/sh", {"-c", "PATH=\"$(dirname '" RELJEF_BINARY "'):$PATH\"; " + command}, options);
    EXPECT_EQ(rendered.exit_code, 0) << command << rendered.err;
    const auto window = io::read_image(folder.path() / "reljef-0001.png");
    const auto picture = io::read_image(folder.path() / "view.png");
    ASSERT_TRUE(window && picture) << command;
    EXPECT_TRUE(std::ranges::equal(window->samples(), picture->samples())) << command;
}

// The view behind a panel does not turn, zoom or end; Tab gives the mouse back to it.
TEST(ViewCommand, PanelsOfARealWindowTakeTheMouseUntilTabHidesThem) {
    if (!can_drive()) {
        GTEST_SKIP() << "no display or no xdotool";
    }
    const test::TemporaryFolder folder;
    const auto result =
        drive(folder, "titled 'texture - still'\n"
                      "xdotool windowsize --sync $window 1024 768; titled still\n"
                      "state() { xdotool getwindowname $window | sed 's/.* triangles//'; }\n"
                      "point() { xdotool mousemove --window $window $1 $2; sleep 0.3; }\n"
                      "changed() { [ \"$(state)\" != \"$before\" ]; }\n"
                      "settled() { before=$(state); sleep 1.5; ! changed; }\n"
                      "point 100 60; until_true settled; xdotool click 4; sleep 1\n"
                      "changed && echo 'the wheel went through the panel'\n"
                      "pressed h; sleep 0.5; pressed Escape; sleep 0.5\n"
                      "pressed Tab; sleep 0.5; xdotool click 4; until_true changed\n"
                      "pressed Escape");
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    EXPECT_THAT(result.out, Not(HasSubstr("went through")));
}

TEST(ViewCommand, CtrlCClosesTheWindow) {
    if (!can_drive()) {
        GTEST_SKIP() << "no display or no xdotool";
    }
    const test::TemporaryFolder folder;
    const auto result = drive(folder, "pressed p; titled fps; kill -INT $viewer");
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    EXPECT_EQ(test::without_progress(result.err), "");
}

} // namespace
} // namespace reljef::app
