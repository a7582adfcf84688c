// The programs of docs/irrlicht.md.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "tests/app/command_line.h"
#include "tests/app/window/driven_window.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_pattern.h"

namespace reljef {
namespace {

using testing::HasSubstr;

std::string grey_slope() {
    std::string text = "P5\n32 32\n255\n";
    for (int i = 0; i < 32 * 32; ++i) {
        text += static_cast<char>(4 * (i % 32));
    }
    return text;
}

test::ProgramResult run_example(const std::string& answer, test::ProgramOptions options) {
    const test::TemporaryFolder folder;
    const auto heights = folder.write("heights.pgm", grey_slope());
    const auto colors = folder.write("colors.pgm", grey_slope());
    options.input = folder.write("answer", answer);
    return test::run_program(RELJEF_IRRLICHT_EXAMPLE, {heights.string(), colors.string(), "2"},
                             options);
}

// Of each C++ block of the page.
std::vector<int> lines_of_programs() {
    std::ifstream page(RELJEF_IRRLICHT_PAGE);
    std::vector<int> lines;
    bool inside = false;
    for (std::string line; std::getline(page, line);) {
        if (line.rfind("```", 0) == 0) {
            inside = line == "```cpp";
            lines.resize(lines.size() + (inside ? 1 : 0));
        } else if (inside) {
            ++lines.back();
        }
    }
    return lines;
}

TEST(IrrlichtExample, HasAtMost120Lines) {
    const std::vector<int> lines = lines_of_programs();
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_GT(lines[0], 50);
    EXPECT_LE(lines[0], 120);
    EXPECT_LE(lines[1], 60);
}

// "Scene::add_mesh", "session::Device" …
std::vector<std::string> names_on_page() {
    const std::string page = test::read_bytes(RELJEF_IRRLICHT_PAGE);
    std::vector<std::string> names;
    for (
        const auto& name : test::matches(
            page,
            R"(\b(?:scene|session|platform|view|material|io|building|Scene|Node|Material)::(\w+))")) {
        names.push_back(name[1]);
    }
    return names;
}

// The words of a text: letters, digits and '_'.
std::set<std::string> words_of(const std::string& text) {
    std::set<std::string> words;
    std::string word;
    for (const char c : text + " ") {
        if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_') {
            word += c;
        } else if (!word.empty()) {
            words.insert(std::exchange(word, {}));
        }
    }
    return words;
}

TEST(IrrlichtExample, ThePageNamesWhatTheLibraryHas) {
    const auto engine = std::filesystem::path(RELJEF_IRRLICHT_PAGE).parent_path() / ".." / "engine";
    std::set<std::string> words;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(engine)) {
        if (entry.path().extension() == ".h") {
            words.merge(words_of(test::read_bytes(entry.path())));
        }
    }
    const auto names = names_on_page();
    EXPECT_GE(names.size(), 30U);
    for (const std::string& name : names) {
        EXPECT_TRUE(words.contains(name)) << name;
    }
}

TEST(IrrlichtExample, DrawsReliefAndParallaxInAWindow) {
    RELJEF_RELEASE_ONLY("it is built with all tests only");
    if (!test::has_display()) {
        GTEST_SKIP() << "no display";
    }
    for (const std::string answer : {"y\n", "n\n"}) {
        const auto result = run_example(answer, {});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.err, "");
    }
}

// Runs the example's window in `folder`: "$1" is the example, "$2" and "$3" are its pictures.
// `titled TEXT` waits until the title begins with it, `pressed KEY TIMES` presses a key, `pictured
// NAME` saves what the window shows.
constexpr const char* driving =
    "\"$1\" \"$2\" \"$3\" < answer & example=$!\n"
    "until_true() { for _ in $(seq 300); do \"$@\" && return; sleep 0.1; done\n"
    "    echo \"never: $*: $(xdotool getwindowname $window)\"; kill $example; exit 9; }\n"
    "is_open() {\n"
    "    window=$(xdotool search --all --onlyvisible --pid $example --name ' per second$' "
    "2>/dev/null | head -n 1); [ -n \"$window\" ]; }\n"
    "has_title() { [[ $(xdotool getwindowname $window) == \"$1, \"* ]]; }\n"
    "titled() { until_true has_title \"$1\"; }\n"
    "pressed() { for _ in $(seq $2); do xdotool key --window $window $1; done; }\n"
    "pictured() { sleep 1; ffmpeg -v error -f x11grab -draw_mouse 0 -i \"$DISPLAY\" -frames:v 1 "
    "$1.png; }\n"
    "until_true is_open\n";

test::ProgramResult drive_example(const test::TemporaryFolder& folder, const std::string& answer,
                                  const std::string& steps) {
    std::string waves = "P5\n64 64\n255\n";
    for (int i = 0; i < 64 * 64; ++i) {
        waves +=
            static_cast<char>(128.0 + 100.0 * std::sin(0.3 * (i % 64)) * std::cos(0.2 * i / 64));
    }
    test::ProgramOptions options;
    options.folder = folder.path();
    options.environment["LP_NUM_THREADS"] = "1"; // it draws all the time: not on all processors
    folder.write("answer", answer);
    const auto heights = folder.write("heights.pgm", waves);
    const auto colors = folder.write("colors.pgm", grey_slope());
    return test::run_program("/bin/bash",
                             {"-c", driving + steps + "kill $example; wait $example; exit 0",
                              "drive", RELJEF_IRRLICHT_EXAMPLE, heights.string(), colors.string()},
                             options);
}

bool can_watch() {
    return test::can_drive() && std::filesystem::exists("/usr/bin/ffmpeg");
}

// Share of the samples of two pictures that differ; 1 if one cannot be read.
double changed_share(const test::TemporaryFolder& folder, const char* before, const char* after) {
    const auto a = io::read_image(folder.path() / before);
    const auto b = io::read_image(folder.path() / after);
    if (!a || !b || a->samples().size() != b->samples().size()) {
        ADD_FAILURE() << before << " and " << after << " cannot be compared";
        return 1.0;
    }
    std::size_t changed = 0;
    for (std::size_t i = 0; i < a->samples().size(); ++i) {
        changed += a->samples()[i] != b->samples()[i] ? 1U : 0U;
    }
    return static_cast<double>(changed) / static_cast<double>(a->samples().size());
}

TEST(IrrlichtExample, KeysChangeTheStepsOfReliefAndItsPicture) {
    RELJEF_RELEASE_ONLY("it is built with all tests only");
    if (!can_watch()) {
        GTEST_SKIP() << "no display, no xdotool or no ffmpeg";
    }
    const test::TemporaryFolder folder;
    const auto result = drive_example(folder, "y\n",
                                      "titled relief:n=11,k=8; pictured start; pictured same\n"
                                      "pressed a 2; titled relief:n=13,k=8\n"
                                      "pressed w 1; pressed d 1; titled relief:n=12,k=8\n"
                                      "pressed d 14; titled relief:n=1,k=8; pictured one\n"
                                      "pressed a 1; titled relief:n=2,k=8\n");
    ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
    EXPECT_EQ(changed_share(folder, "start.png", "same.png"), 0.0);
    EXPECT_GT(changed_share(folder, "start.png", "one.png"), 0.01);
}

TEST(IrrlichtExample, KeysAndTheMouseChangeParallaxAndTheCamera) {
    RELJEF_RELEASE_ONLY("it is built with all tests only");
    if (!can_watch()) {
        GTEST_SKIP() << "no display, no xdotool or no ffmpeg";
    }
    const test::TemporaryFolder folder;
    const auto result =
        drive_example(folder, "n\n",
                      "titled parallax:offset=-0.5; pictured start\n"
                      "pressed w 2; titled parallax:offset=-0.48\n"
                      "pressed a 1; pressed s 3; titled parallax:offset=-0.51\n"
                      "pressed w 60; titled parallax:offset=0; pictured shifted\n"
                      "xdotool keydown --window $window Up; sleep 1\n"
                      "xdotool keyup --window $window Up; pictured moved\n"
                      "xdotool mousemove --window $window 400 400; sleep 0.2\n"
                      "xdotool mousemove --window $window 460 400; pictured turned\n"
                      "titled parallax:offset=0\n");
    ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
    EXPECT_GT(changed_share(folder, "start.png", "shifted.png"), 0.01);
    EXPECT_GT(changed_share(folder, "shifted.png", "moved.png"), 0.01);
    EXPECT_GT(changed_share(folder, "moved.png", "turned.png"), 0.01);
}

TEST(IrrlichtExample, WhatMovesIsDrawnWithoutAWindow) {
    RELJEF_RELEASE_ONLY("it is built with all tests only");
    const test::TemporaryFolder folder;
    std::string heights = "P5\n201 201\n255\n";
    for (int i = 0; i < 201 * 201; ++i) {
        heights += static_cast<char>(20 + i % 201 / 10);
    }
    const auto ground = folder.write("heights.pgm", heights);
    test::ProgramOptions options;
    options.folder = folder.path();
    const auto result = test::run_program(RELJEF_MOTION_EXAMPLE, {ground.string()}, options);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const std::string first = test::read_bytes(folder.path() / "walk-1.png");
    const std::string second = test::read_bytes(folder.path() / "walk-2.png");
    EXPECT_GT(first.size(), 1000U);
    EXPECT_NE(first, second);
}

TEST(IrrlichtExample, WithoutADisplayOrPicturesFailsInOneSentence) {
    RELJEF_RELEASE_ONLY("it is built with all tests only");
    test::ProgramOptions options;
    options.environment = {{"DISPLAY", std::nullopt}, {"WAYLAND_DISPLAY", std::nullopt}};
    const auto no_display = run_example("y\n", options);
    EXPECT_EQ(no_display.exit_code, 1);
    EXPECT_THAT(no_display.err, HasSubstr("no display"));
    EXPECT_EQ(std::count(no_display.err.begin(), no_display.err.end(), '\n'), 1) << no_display.err;
    const auto no_pictures = test::run_program(RELJEF_IRRLICHT_EXAMPLE, {});
    EXPECT_EQ(no_pictures.exit_code, 1);
    EXPECT_THAT(no_pictures.err, HasSubstr("two pictures were expected"));
}

} // namespace
} // namespace reljef
