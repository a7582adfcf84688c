#include <gtest/gtest.h>

#include "tests/app/command_line.h"
#include "tests/support/temporary_folder.h"

namespace reljef {
namespace {

// `timeout` ends the program as Ctrl-C (INT), a closed terminal (HUP) or a shutdown (TERM) does.
test::ProgramResult interrupted_after(const std::string& seconds,
                                      std::vector<std::string> arguments,
                                      const std::string& signal = "INT") {
    std::vector<std::string> all{"--preserve-status", "-s", signal, seconds, RELJEF_BINARY};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return test::run_program("/usr/bin/timeout", all);
}

TEST(CtrlC, HasTheExitStatusThatTheHelpTells) {
    const auto help = test::reljef({"--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_NE(help.out.find("1 failed, or ended by Ctrl-C (SIGINT, SIGTERM or SIGHUP); 2 misused"),
              std::string::npos)
        << help.out;
}

TEST(CtrlC, ends_a_long_flight_and_leaves_no_rubbish) {
    const test::TemporaryFolder folder;
    const auto video = (folder.path() / "flight.mp4").string();
    const auto result =
        interrupted_after("4", {"render", "natural", "--path", "orbit", "--frames", "100000",
                                "--size", "64x48", "--context", "osmesa", "--quiet", "-o", video});
    if (result.err.find("ffmpeg was not found") != std::string::npos) {
        GTEST_SKIP() << "no ffmpeg here";
    }
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.err, "reljef: interrupted\n");
    EXPECT_TRUE(folder.names().empty());
}

// Later where the signal came before main() had begun: a busy machine loads the libraries slowly.
test::ProgramResult interrupted_while_drawing(const std::string& picture, const char* signal) {
    test::ProgramResult result;
    for (const char* const seconds : {"1", "2", "4"}) {
        result = interrupted_after(seconds,
                                   {"render", "natural", "--size", "8192x8192", "--context",
                                    "osmesa", "--quiet", "-o", picture},
                                   signal);
        if (result.exit_code < 128) {
            break;
        }
    }
    return result;
}

TEST(CtrlC, EndsWhileOnePictureIsDrawn) {
    const test::TemporaryFolder folder;
    const auto picture = (folder.path() / "large.png").string();
    for (const char* signal : {"INT", "HUP", "TERM"}) {
        const auto result = interrupted_while_drawing(picture, signal);
        EXPECT_EQ(result.exit_code, 1) << signal;
        EXPECT_EQ(result.err, "reljef: interrupted\n") << signal;
        EXPECT_TRUE(folder.names().empty()) << signal;
    }
}

} // namespace
} // namespace reljef
