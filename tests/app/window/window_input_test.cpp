// Windows and inputs that are bad or odd: one sentence, an exit code, and nothing lost.
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "tests/app/command_line.h"
#include "tests/app/window/driven_window.h"
#include "tests/session/made_waves.h"
#include "tests/support/release_only.h"

namespace reljef::app {
namespace {

using testing::HasSubstr;

class ViewWindowInput : public testing::Test {
protected:
    void SetUp() override {
        if (!test::has_display()) {
            GTEST_SKIP() << "no display";
        }
    }
    test::ProgramResult view(std::vector<std::string> more) {
        std::vector<std::string> arguments{"view", test::small_terrain(folder_, "natural"),
                                           "--frames", "1"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return test::reljef(arguments);
    }

    test::TemporaryFolder folder_;
};

TEST_F(ViewWindowInput, ANonsenseRampFileIsOneSentence) {
    const std::string path = folder_.write("ramp.txt", "no colours at all\n").string();
    test::expect_refusal(view({"--ramp", path}), 1, {"ramp.txt"});
    const std::string bytes =
        folder_.write("bytes.txt", std::string("\0\xff\x80 1 2\n\n", 9)).string();
    test::expect_refusal(view({"--ramp", bytes}), 1, {"bytes.txt"});
    test::expect_refusal(view({"--ramp", folder_.path() / "none.txt"}), 2, {"none.txt"});
}

TEST_F(ViewWindowInput, ADateBeyondTheSunsFormulaIsOneSentence) {
    const std::string waves = folder_.path() / "waves.tif";
    test::write_waves(waves, 40, 30);
    for (const char* const date : {"1799-12-31T12:00", "2201-01-01T12:00", "9999-06-21T12:00"}) {
        const auto result =
            test::reljef({"view", waves, "--quiet", "--frames", "1", "--sun", date});
        test::expect_refusal(result, 2, {std::string(date).substr(0, 4), "1800", "2200"});
    }
    test::expect_refusal(test::reljef({"view", waves, "--sun", "2026-13-01T12:00"}), 2,
                         {"--sun", "2026-13-01"});
    EXPECT_EQ(test::reljef({"view", waves, "--quiet", "--sun", "2200-06-21T12:00", "--frames", "1"})
                  .exit_code,
              0);
}

TEST_F(ViewWindowInput, APathOfOneKeyframeIsShownAndSaid) {
    const std::string path =
        folder_.write("one.toml", "[[key]]\ntime = 0.0\neye = [0, -900, 400]\nlook = [0, 0, 0]\n")
            .string();
    const auto result = view({"--path", path, "--size", "320x240"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(test::without_progress(result.err),
                HasSubstr("one.toml: one keyframe found, at least two were expected"));
}

TEST_F(ViewWindowInput, OnePixelAndManyMillionsAreDrawn) {
    for (const char* const size : {"1x1", "1x300", "7680x4320"}) {
        const auto result = view({"--technique", "texture", "--size", size});
        EXPECT_EQ(result.exit_code, 0) << size << result.err;
        EXPECT_EQ(test::without_progress(result.err), "") << size;
    }
    test::expect_refusal(view({"--size", "0x1"}), 2, {"0x1"});
    test::expect_refusal(view({"--size", "16385x10"}), 2, {"16385x10"});
}

TEST_F(ViewWindowInput, AWindowThatShrinksToAPixelGoesOn) {
    if (!test::can_drive()) {
        GTEST_SKIP() << "no xdotool";
    }
    const auto result =
        test::drive(folder_,
                    "titled still; pressed space; pressed p; titled fps\n"
                    "xdotool windowsize --sync $window 1 1; sleep 0.3; pressed h; pressed p\n"
                    "xdotool windowsize --sync $window 300 200; pressed space; titled still\n"
                    "pressed c; until_true test -s reljef-0001.png; pressed Escape",
                    test::WindowOptions{.size = "800x600"});
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    const auto picture = io::read_image(folder_.path() / "reljef-0001.png");
    ASSERT_TRUE(picture) << result.out << result.err;
    EXPECT_EQ(glm::ivec2(picture->cols(), picture->rows()), glm::ivec2(300, 200));
}

// A server of its own, which has no GLX.
TEST(ViewWithoutGlx, SaysWhatIsMissingAndWhatElseThereIs) {
    if (!std::filesystem::exists("/usr/bin/Xvfb")) {
        GTEST_SKIP() << "no Xvfb";
    }
    const test::TemporaryFolder folder;
    test::ProgramOptions options;
    options.folder = folder.path();
    options.environment = {{"WAYLAND_DISPLAY", std::nullopt}};
    const auto result = test::run_program(
        "/bin/bash",
        {"-c", "Xvfb -displayfd 3 -extension GLX -screen 0 320x240x24 3>display 2>/dev/null &\n"
               "server=$!\n"
               "for _ in $(seq 300); do [ -s display ] && break; sleep 0.1; done\n"
               "DISPLAY=:$(cat display) '" RELJEF_BINARY "' view natural --quiet\n"
               "status=$?; kill $server; exit $status\n"},
        options);
    test::expect_refusal(result, 1, {"OpenGL", "GLX", "reljef render"});
}

// What the background has proven is kept, or begun anew: never damaged.
TEST_F(ViewWindowInput, ClosedWhileTheIndexIsMadeItLeavesOneThatGoesOn) {
    RELJEF_RELEASE_ONLY("the raster is large");
    if (!test::can_drive()) {
        GTEST_SKIP() << "no xdotool";
    }
    const std::string waves = folder_.path() / "waves.tif";
    test::write_waves(waves, 4000, 2400);
    const auto environment = [&](const char* cache) {
        return std::map<std::string, std::optional<std::string>>{
            {"XDG_CACHE_HOME", (folder_.path() / cache).string()}};
    };
    // The index takes a second from the first picture on, at which the window has its title.
    const auto result = test::drive(folder_, "pressed Escape",
                                    test::WindowOptions{.options = "--quiet --memory 8",
                                                        .terrain = waves,
                                                        .title = "waves",
                                                        .environment = environment("closed")});
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    EXPECT_EQ(test::without_progress(result.err), "");
    const auto index = [&](const char* cache) {
        test::ProgramOptions options;
        options.environment = environment(cache);
        return test::reljef({"index", waves, "--memory", "8", "--quiet"}, options);
    };
    const auto goes_on = index("closed");
    const auto anew = index("fresh");
    EXPECT_EQ(goes_on.exit_code, 0) << goes_on.err;
    const auto table = [](const std::string& out) { return out.substr(0, out.find("; errors")); };
    EXPECT_EQ(table(goes_on.out), table(anew.out));
    EXPECT_THAT(anew.out, HasSubstr(" 0 unproven"));
}

} // namespace
} // namespace reljef::app
