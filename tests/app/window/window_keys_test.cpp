// Keys and clicks of a real window, where no test of app/viewer or the panels can press them.
#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/io/image/image.h"
#include "tests/app/window/driven_window.h"

namespace reljef::app {
namespace {

using testing::HasSubstr;
using testing::Not;

// `copied` prints the command that renders the view and waits until that is done: a picture
// follows.
constexpr const char* copying = "copied() { pressed z; pressed c; count=$((count + 1))\n"
                                "    until_true test -s reljef-$(printf %04d $count).png; }\n";

std::vector<std::string> commands_in(const std::string& output) {
    std::vector<std::string> commands;
    std::istringstream lines(output);
    for (std::string line; std::getline(lines, line);) {
        if (const auto begin = line.find("reljef render "); begin != std::string::npos) {
            commands.push_back(line.substr(begin));
        }
    }
    return commands;
}

TEST(ViewWindow, KeysChangeParametersLightAndComparison) {
    if (!test::can_drive()) {
        GTEST_SKIP() << "no display or no xdotool";
    }
    const test::TemporaryFolder folder;
    const auto result =
        test::drive(folder,
                    copying + std::string("titled 'relief'; titled still; copied\n"
                                          "pressed bracketright; pressed bracketright\n"
                                          "pressed period; pressed bracketleft; copied\n"
                                          "pressed comma; pressed bracketleft; copied\n"
                                          "pressed space; pressed minus; copied\n"
                                          "pressed equal; pressed equal; copied\n"
                                          "pressed Return; copied; pressed backslash; copied\n"
                                          "pressed space; pressed l; copied\n"
                                          "pressed F12; count=$((count + 1))\n"
                                          "until_true test -s reljef-0009.png\n"
                                          "pressed Escape"),
                    "--technique relief --sun 200,40 --no-panels --quiet");
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    const auto commands = commands_in(result.out);
    ASSERT_EQ(commands.size(), 8U) << result.out;
    const auto expect = [&](std::size_t i, const char* part) {
        EXPECT_THAT(commands[i], HasSubstr(part)) << i;
    };
    expect(0, "--sun 200,40");
    expect(0, "--technique relief:n=11,k=8");
    expect(1, "--technique relief:n=13,k=7");
    expect(2, "--technique relief:n=12,k=7");
    EXPECT_THAT(commands[2], Not(HasSubstr("--compare")));
    expect(3, "--compare truth --wipe 0.450");
    expect(4, "--compare truth --wipe 0.550");
    expect(5, "--compare errors --wipe 0.550");
    expect(6, "--compare ");
    EXPECT_NE(commands[6], commands[5]);
    expect(7, "--sun 215,40");
    EXPECT_THAT(commands[7], Not(HasSubstr("--compare")));
}

TEST(ViewWindow, KeysRecordBookmarkAndPrint) {
    if (!test::can_drive()) {
        GTEST_SKIP() << "no display or no xdotool";
    }
    const test::TemporaryFolder folder;
    const auto result = test::drive(
        folder, // each picture is of a later frame, which the path has
        "titled still; pressed g; pressed k; pressed d\n"
        "pressed c; until_true test -s reljef-0001.png\n"
        "pressed c; until_true test -s reljef-0002.png\n"
        "pressed k; until_true test -e reljef-path-0001.toml\n"
        "pressed Insert; pressed Delete; pressed n; pressed i; pressed u\n"
        "pressed v; pressed ctrl+c; pressed Home; pressed F1\n"
        "pressed x; pressed x; pressed b; until_true test -s data/reljef/bookmarks.txt\n"
        "pressed j; until_true test -e reljef-path-0002.toml; pressed Escape");
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    for (const char* part : {"recording the flight; K ends it", "saved reljef-path-0001.toml",
                             "keyframe ", "keyframes\n", "--eye ", "measuring: click on the ground",
                             "measuring ends", "bookmark view 1"}) {
        EXPECT_THAT(result.out, HasSubstr(part));
    }
    const auto count = [&](const std::string& text) {
        std::size_t found = 0;
        for (auto at = result.out.find(text); at != std::string::npos;
             at = result.out.find(text, at + 1)) {
            ++found;
        }
        return found;
    };
    EXPECT_EQ(count("fly along the path"), 2U) << "at the start, and by F1 without room";
    EXPECT_GE(count("--eye "), 2U) << "by V and by Ctrl-C";
    for (const char* part : {"no bookmark; B makes one", "X measures", "no measured point found"}) {
        EXPECT_THAT(result.err, HasSubstr(part));
    }
}

// Clicks go down along the panel until its button has saved the picture.
TEST(ViewWindow, StatsTellThePicturePanelsAndClicks) {
    if (!test::can_drive()) {
        GTEST_SKIP() << "no display or no xdotool";
    }
    const test::TemporaryFolder folder;
    const auto result = test::drive(
        folder,
        "titled still; saved() { test -s reljef-0001.png; }\n"
        "click_up() { for y in $(seq 720 -10 120); do saved && return; clicked 950 $y; done; }\n"
        "until_true eval 'click_up; saved'\n"
        "pressed p; titled fps; pressed p; titled still\n"
        "pressed Tab; pressed p; titled fps; pressed p; titled still; pressed Escape",
        test::WindowOptions{.options = "--technique texture --stats --json", .size = "1024x768"});
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    const auto begin = result.out.find("{\n");
    ASSERT_NE(begin, std::string::npos) << result.out;
    EXPECT_THAT(result.out.substr(0, begin), Not(HasSubstr("fly along the path")));
    const auto json = nlohmann::json::parse(result.out.substr(begin), nullptr, false);
    ASSERT_FALSE(json.is_discarded()) << result.out;
    EXPECT_GT(json["first_picture_s"].get<double>(), 0.0);
    EXPECT_GE(json["complete_picture_s"].get<double>(), json["first_picture_s"].get<double>());
    for (const char* const row : {"frames_with_panels", "frames_without_panels", "panels_drawn",
                                  "panels_hidden", "keys", "controls"}) {
        EXPECT_GT(json[row]["count"].get<int>(), 0) << row;
    }
    EXPECT_EQ(json["controls"]["max_frames"], 1) << "a click is answered by the next frame";
}

} // namespace
} // namespace reljef::app
