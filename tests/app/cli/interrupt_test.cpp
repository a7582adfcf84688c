#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/cli/interrupt.h"
#include "engine/core/atomic_file.h"
#include "tests/app/command_line.h"
#include "tests/support/nginx.h"
#include "tests/support/process_state.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

namespace reljef {
namespace {

TEST(CtrlC, HasTheExitStatusThatTheHelpTells) {
    const auto help = test::reljef({"--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_NE(help.out.find("1 failure, or ended by Ctrl-C (SIGINT, SIGTERM or SIGHUP); 2 unknown"),
              std::string::npos)
        << help.out;
}

TEST(CtrlC, ends_a_long_flight_and_leaves_no_rubbish) {
    const test::TemporaryFolder folder;
    const test::TemporaryFolder scenes;
    test::ProgramOptions options;
    options.interruption = {SIGINT, [&](int process) { // the video has begun
                                return !folder.names().empty() &&
                                       test::processor_seconds(process, "llvmpipe") > 0.1;
                            }};
    const auto result =
        test::run_program(RELJEF_BINARY,
                          {"render", test::small_terrain(scenes, "natural"), "--path", "orbit",
                           "--frames", "100000", "--size", "64x48", "--context", "osmesa",
                           "--quiet", "-o", (folder.path() / "flight.mp4").string()},
                          options);
    if (result.err.find("ffmpeg was not found") != std::string::npos) {
        GTEST_SKIP() << "no ffmpeg here";
    }
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.err, "reljef: interrupted\n");
    EXPECT_TRUE(folder.names().empty());
}

// As a closed terminal (HUP) and a shutdown (TERM) do.
TEST(CtrlC, EndsWhileOnePictureIsDrawn) {
    const test::TemporaryFolder folder;
    const std::string dem =
        folder
            .write("dem.asc", "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 10\n"
                              "1 2 3\n4 5 6\n7 8 9\n")
            .string();
    for (const int signal : {SIGINT, SIGHUP, SIGTERM}) {
        test::ProgramOptions options;
        options.interruption = {
            signal, [](int process) { return test::processor_seconds(process, "llvmpipe") > 0.1; }};
        const auto result = test::run_program(RELJEF_BINARY,
                                              {"render", dem, "--size", "8192x8192", "--context",
                                               "osmesa", "--technique", "exact", "--quiet", "-o",
                                               (folder.path() / "large.png").string()},
                                              options);
        EXPECT_EQ(result.exit_code, 1) << signal;
        EXPECT_EQ(result.err, "reljef: interrupted\n") << signal;
        EXPECT_EQ(folder.names(), std::vector<std::string>{"dem.asc"}) << signal;
    }
}

// Nothing interrupts a driver, such as one that runs a slow shader.
TEST(CtrlC, EndsAViewerThatWaitsForADriver) {
    const pid_t child = ::fork();
    if (child == 0) {
        const cli::Interrupt interrupt;
        interrupt.end_after(std::chrono::milliseconds(100));
        ::kill(::getpid(), SIGTERM);
        std::this_thread::sleep_for(std::chrono::minutes(1));
        ::_exit(interrupt.requested() ? 1 : 2);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 128 + SIGTERM);
}

// Esc, or a closed window, while work in the background runs that nothing interrupts.
TEST(CtrlC, EndsAViewerThatWasClosedWithSuccess) {
    const pid_t child = ::fork();
    if (child == 0) {
        const cli::Interrupt interrupt;
        interrupt.end_after(std::chrono::milliseconds(100));
        interrupt.request_stop();
        std::this_thread::sleep_for(std::chrono::minutes(1));
        ::_exit(interrupt.requested() ? 1 : 2);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(CtrlC, EndsWithoutTemporaryFilesOfWorkThatGoesOn) {
    const test::TemporaryFolder folder;
    const test::TemporaryFolder others;
    const auto of_parent = AtomicFile::create(others.path() / "file");
    ASSERT_TRUE(of_parent);
    const pid_t child = ::fork();
    if (child == 0) {
        ::closefrom(STDERR_FILENO + 1);
        const Descriptor seen(::open(of_parent->temporary().c_str(), O_RDONLY));
        auto first = AtomicFile::create(folder.path() / "file");
        const AtomicFile moved = std::move(*first);
        const auto scratch = ScratchFolder::create(folder.path());
        auto done = write_text_file(folder.path() / "done", "all of it");
        if (!scratch || !done || folder.names().size() != 3) {
            ::_exit(2);
        }
        const cli::Interrupt interrupt;
        interrupt.end_after(std::chrono::milliseconds(100), "ended\n");
        ::kill(::getpid(), SIGTERM);
        std::this_thread::sleep_for(std::chrono::minutes(1));
        ::_exit(3);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 1);
    EXPECT_EQ(folder.names(), std::vector<std::string>{"done"});
    EXPECT_EQ(others.names().size(), 1U) << "the temporary file of another process";
}

TEST(CtrlC, WaitsForWorkThatEndsByItself) {
    const pid_t child = ::fork();
    if (child == 0) {
        const cli::Interrupt interrupt;
        interrupt.end_after(std::chrono::milliseconds(100), "ended\n");
        interrupt.end_after({});
        ::kill(::getpid(), SIGTERM);
        std::this_thread::sleep_for(std::chrono::milliseconds(600));
        ::_exit(interrupt.requested() ? 3 : 2);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 3);
}

// The frame would take hours.
TEST(CtrlC, EndsAPictureOfASlowShaderAndLeavesNoRubbish) {
    const test::TemporaryFolder folder;
    const test::TemporaryFolder scenes;
    const std::string shader =
        scenes
            .write("slow.glsl",
                   "vec3 bent(vec3 v) { return sin(v * 3.7) + cos(v.yzx * 5.3) + exp(-v * v); }\n"
                   "vec3 surface_color(Surface surface) {\n    vec3 light = surface.light;\n"
                   "    for (int i = 0; i < 60000; ++i) {\n"
                   "        light = bent(bent(bent(bent(light))));\n"
                   "    }\n    return light;\n}\n")
            .string();
    const std::string terrain = test::small_terrain(scenes, "natural");
    const std::string picture = (folder.path() / "slow.png").string();
    const std::string frames = (folder.path() / "slow-%04d.png").string();
    const std::string hits = (folder.path() / "hit.exr").string();
    for (const std::vector<std::string>& outputs :
         {std::vector<std::string>{"-o", picture, "--hit", hits},
          {"-o", frames, "--path", "orbit", "--frames", "2"}}) {
        test::ProgramOptions options;
        options.interruption = {SIGTERM, [](int process) {
                                    return test::processor_seconds(process, "llvmpipe") > 0.5;
                                }};
        std::vector<std::string> arguments{"render",    terrain,  "--surface-shader",
                                           shader,      "--size", "1024x1024",
                                           "--context", "osmesa", "--quiet"};
        arguments.insert(arguments.end(), outputs.begin(), outputs.end());
        const auto result = test::run_program(RELJEF_BINARY, arguments, options);
        EXPECT_FALSE(result.timed_out);
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_EQ(result.err, "reljef: interrupted\n");
        EXPECT_TRUE(folder.names().empty());
    }
}

// A server that is fast enough for every deadline, but takes minutes.
TEST(CtrlC, EndsAReadFromASlowServer) {
    RELJEF_NEED_NGINX();
    RELJEF_NEED_DATA("natural/srtm3/N45E006.hgt");
    const test::Nginx server(test::data_path("natural/srtm3"),
                             "limit_rate_after 16k; limit_rate 2500;");
    const test::TemporaryFolder folder;
    for (const std::vector<std::string>& verb :
         {std::vector<std::string>{"info"},
          {"render", "--context", "osmesa", "-o", (folder.path() / "a.png").string()},
          {"height", "--at", "45.5,6.5"}}) {
        std::vector<std::string> arguments = verb;
        arguments.insert(arguments.begin() + 1, {server.url("N45E006.hgt"), "--quiet"});
        const std::size_t sent = server.bytes_sent();
        std::chrono::steady_clock::time_point interrupted;
        test::ProgramOptions options;
        options.interruption = {SIGINT, [&](int /*process*/) { // the file's beginning is there
                                    interrupted = std::chrono::steady_clock::now();
                                    return server.bytes_sent() >= sent + 16384;
                                }};
        const auto result = test::run_program(RELJEF_BINARY, arguments, options);
        EXPECT_LT(std::chrono::steady_clock::now() - interrupted, std::chrono::seconds(10));
        EXPECT_EQ(result.exit_code, 1) << verb.front();
        EXPECT_EQ(result.err, "reljef: interrupted\n") << verb.front();
        EXPECT_TRUE(folder.names().empty()) << verb.front();
    }
}

// As nohup starts it.
TEST(CtrlC, ASignalThatIsIgnoredAtTheStartStaysIgnored) {
    const test::TemporaryFolder folder;
    const std::string picture = (folder.path() / "a.png").string();
    test::ProgramOptions options;
    bool was_sent = false;
    options.interruption = {SIGHUP, [&](int process) {
                                was_sent = test::processor_seconds(process, "llvmpipe") > 0.02;
                                return was_sent;
                            }};
    const auto result = test::run_program("/bin/sh",
                                          {"-c", "trap '' HUP; exec '" RELJEF_BINARY
                                                 "' render natural --size 1024x768 --context "
                                                 "osmesa --quiet -o '" +
                                                     picture + "'"},
                                          options);
    EXPECT_TRUE(was_sent);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(std::filesystem::exists(picture));
}

} // namespace
} // namespace reljef
