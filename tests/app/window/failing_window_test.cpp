// A window that is open while its terrain fails.
#include <algorithm>
#include <chrono>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/command_line.h"
#include "tests/app/window/driven_window.h"
#include "tests/support/temporary_folder.h"

namespace reljef::app {
namespace {

// Opens a terrain that is none, waits for the sentence in the title, and does `end`.
test::ProgramResult fail_in_window(const test::TemporaryFolder& folder, const std::string& end) {
    const std::string script =
        "env --default-signal=INT '" RELJEF_BINARY
        "' view broken.tif --size 800x600 2> errors & viewer=$!\n"
        "find_window() { window=$(xdotool search --all --onlyvisible --pid $viewer --name "
        "'^reljef - broken.tif: ' 2>/dev/null | head -n 1); [ -n \"$window\" ]; }\n"
        "for _ in $(seq 300); do find_window && break; sleep 0.1; done\n"
        "kill -0 $viewer || echo 'the window did not stay'\n"
        "[ -s errors ] || echo 'the sentence is not on stderr while the window is open'\n"
        // xdotool complains if its window is gone before the key is released.
        "sleep 0.5; { " +
        end +
        "; } 2>/dev/null\nwait $viewer; status=$?; cat errors >&2; xdotool keyup Escape; "
        "exit $status\n";
    folder.write("broken.tif", "no raster");
    test::ProgramOptions options;
    options.folder = folder.path();
    options.timeout = std::chrono::seconds(100);
    return test::run_program("/bin/bash", {"-c", script}, options);
}

TEST(ViewCommand, TheWindowShowsWhyNothingOpensUntilEsc) {
    if (!test::can_drive()) {
        GTEST_SKIP() << "no display or no xdotool";
    }
    const test::TemporaryFolder folder;
    const auto result = fail_in_window(folder, "xdotool key --window $window Escape");
    EXPECT_EQ(result.exit_code, 1) << result.out << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, testing::StartsWith("reljef: broken.tif: "));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
}

TEST(ViewCommand, CtrlCLosesNoSentenceOfTheWindow) {
    if (!test::can_drive()) {
        GTEST_SKIP() << "no display or no xdotool";
    }
    const test::TemporaryFolder folder;
    const auto result = fail_in_window(folder, "kill -INT $viewer");
    EXPECT_EQ(result.exit_code, 1) << result.out << result.err;
    EXPECT_THAT(result.err, testing::StartsWith("reljef: broken.tif: "));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
}

} // namespace
} // namespace reljef::app
