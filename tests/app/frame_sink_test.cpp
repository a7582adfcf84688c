#include "app/rendering/frame_sink.h"

#include <gtest/gtest.h>

#include "engine/core/atomic_file.h"
#include "tests/support/temporary_folder.h"

namespace reljef::app {
namespace {

Result<void> finish(FrameSink& sink) {
    std::vector<AtomicFile> outputs;
    auto finished = sink.finish(outputs);
    return finished ? commit_all(outputs) : finished;
}

TEST(Numbered, replaces_the_number) {
    EXPECT_EQ(numbered("frames/%04d.png", 7)->string(), "frames/0007.png");
    EXPECT_EQ(numbered("%d.png", 12345)->string(), "12345.png");
    EXPECT_EQ(numbered("%012d", 7)->string(), "000000000007");
}

TEST(Numbered, refuses_any_other_pattern) {
    for (const char* pattern : {"a.png", "%s.png", "%04d-%d.png", "%n%d.png", "%.png",
                                "%99999d.png", "%13d.png", "%-4d.png", "100%.png", "%1"}) {
        EXPECT_FALSE(numbered(pattern, 1)) << pattern;
    }
}

TEST(FrameSink, sequence_makes_its_folder_and_files) {
    const test::TemporaryFolder folder;
    auto sink = make_frame_sink(folder.path() / "a" / "%02d.png", {.size = {4, 3}, .frames = 2});
    ASSERT_TRUE(sink) << sink.error().message;
    EXPECT_TRUE((*sink)->write(Image(4, 3), 0));
    EXPECT_TRUE((*sink)->write(Image(4, 3), 1));
    EXPECT_TRUE(finish(**sink));
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "a" / "01.png"));
}

// A listing for each of N pictures would read N² names.
TEST(FrameSink, TheFolderOfASequenceIsListedOnceForWhatKilledRunsLeft) {
    const test::TemporaryFolder folder;
    const auto leave = [&] {
        const auto file = AtomicFile::create(folder.path() / "a.png");
        return folder.write(file->temporary().filename().string() + "s", "left");
    };
    const auto before = leave();
    auto sink = make_frame_sink(folder.path() / "%d.png", {.size = {4, 3}, .frames = 2});
    ASSERT_TRUE(sink) << sink.error().message;
    EXPECT_FALSE(std::filesystem::exists(before));
    const auto meanwhile = leave();
    EXPECT_TRUE((*sink)->write(Image(4, 3), 0));
    EXPECT_TRUE((*sink)->write(Image(4, 3), 1));
    EXPECT_TRUE(finish(**sink));
    EXPECT_TRUE(std::filesystem::exists(meanwhile));
}

TEST(FrameSink, video_that_is_not_finished_leaves_nothing) {
    const test::TemporaryFolder folder;
    {
        auto sink = make_frame_sink(folder.path() / "flight.mp4", {.size = {33, 21}, .frames = 2});
        if (!sink) {
            GTEST_SKIP() << sink.error().message;
        }
        EXPECT_TRUE((*sink)->write(Image(33, 21), 0));
    }
    EXPECT_TRUE(folder.names().empty());
}

TEST(FrameSink, video_of_odd_size_appears) {
    const test::TemporaryFolder folder;
    auto sink = make_frame_sink(folder.path() / "flight.MP4", {.size = {33, 21}, .frames = 2});
    if (!sink) {
        GTEST_SKIP() << sink.error().message;
    }
    EXPECT_TRUE((*sink)->write(Image(33, 21, Rgba8{200, 100, 50}), 0));
    EXPECT_TRUE((*sink)->write(Image(33, 21), 1));
    const auto finished = finish(**sink);
    ASSERT_TRUE(finished) << finished.error().message;
    EXPECT_EQ(folder.names(), std::vector<std::string>{"flight.MP4"});
    EXPECT_GT(std::filesystem::file_size(folder.path() / "flight.MP4"), 100U);
}

// Names that ffmpeg would take for an option, a protocol or a list of files.
TEST(FrameSink, NoVideoNameIsAnOptionOrAProtocolOfFfmpeg) {
    const test::TemporaryFolder folder;
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(folder.path());
    std::string error;
    for (const std::filesystem::path name : {"-x/y.mp4", "pipe:/y.mp4", "concat:a|b/-y.mp4"}) {
        std::filesystem::create_directories(name.parent_path());
        auto sink = make_frame_sink(name, {.size = {32, 24}, .frames = 1});
        auto written = sink ? (*sink)->write(Image(32, 24), 0) : sink.error();
        const auto done = written ? finish(**sink) : written;
        error += done ? "" : done.error().message + "\n";
        EXPECT_EQ(std::filesystem::exists(name), static_cast<bool>(done)) << name;
    }
    std::filesystem::current_path(before);
    if (error.find("ffmpeg was not found") != std::string::npos) {
        GTEST_SKIP() << error;
    }
    EXPECT_EQ(error, "");
}

// The last of many frames, too: each is written while the next one is drawn.
TEST(FrameSink, APictureOfASequenceThatCannotBeWrittenIsTold) {
    const test::TemporaryFolder folder;
    auto sink = make_frame_sink(folder.path() / "%d.png", {.size = {4, 3}, .frames = 2});
    ASSERT_TRUE(sink) << sink.error().message;
    std::filesystem::create_directory(folder.path() / "1.png");
    EXPECT_TRUE((*sink)->write(Image(4, 3), 0));
    EXPECT_TRUE((*sink)->write(Image(4, 3), 1));
    EXPECT_FALSE(finish(**sink));
}

} // namespace
} // namespace reljef::app
