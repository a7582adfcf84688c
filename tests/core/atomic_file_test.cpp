#include "engine/core/atomic_file.h"

#include <csignal>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "tests/support/temporary_folder.h"

namespace reljef {
namespace {

using test::read_bytes;
using test::TemporaryFolder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(AtomicFile, AppearsOnlyWithCommit) {
    const TemporaryFolder folder;
    auto file = AtomicFile::create(folder.path() / "a.png");
    ASSERT_TRUE(file);
    std::ofstream(file->temporary()) << "whole";
    EXPECT_FALSE(std::filesystem::exists(file->target()));
    ASSERT_TRUE(file->commit());
    EXPECT_THAT(folder.names(), ElementsAre("a.png"));
    EXPECT_EQ(read_bytes(folder.path() / "a.png"), "whole");
}

TEST(AtomicFile, LeavesNothingBehindWithoutCommit) {
    const TemporaryFolder folder;
    {
        auto file = AtomicFile::create(folder.path() / "a.png");
        ASSERT_TRUE(file);
        std::ofstream(file->temporary()) << "half";
        EXPECT_EQ(folder.names().size(), 1U);
    }
    EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(AtomicFile, KeepsTheOldFileUntilCommit) {
    const TemporaryFolder folder;
    folder.write("a.txt", "old");
    {
        auto file = AtomicFile::create(folder.path() / "a.txt");
        ASSERT_TRUE(file);
        std::ofstream(file->temporary()) << "new, not finished";
    }
    EXPECT_EQ(read_bytes(folder.path() / "a.txt"), "old");
    ASSERT_TRUE(write_text_file(folder.path() / "a.txt", "new"));
    EXPECT_EQ(read_bytes(folder.path() / "a.txt"), "new");
    EXPECT_THAT(folder.names(), ElementsAre("a.txt"));
}

TEST(CommitAll, PutsAllFilesInPlaceOrLeavesAllAsTheyWere) {
    for (const bool fails : {false, true}) {
        const TemporaryFolder folder;
        folder.write("a.txt", "old");
        std::vector<AtomicFile> files;
        for (const char* const name : {"a.txt", "b.txt", "c.txt"}) {
            auto file = AtomicFile::create(folder.path() / name);
            ASSERT_TRUE(file);
            std::ofstream(file->temporary()) << "new";
            files.push_back(std::move(*file));
        }
        if (fails) { // no file can take the place of a folder
            std::filesystem::create_directories(folder.path() / "c.txt" / "in");
        }
        EXPECT_EQ(static_cast<bool>(commit_all(files)), !fails);
        files.clear();
        EXPECT_EQ(read_bytes(folder.path() / "a.txt"), fails ? "old" : "new");
        EXPECT_EQ(folder.names(), fails ? (std::vector<std::string>{"a.txt", "c.txt"})
                                        : (std::vector<std::string>{"a.txt", "b.txt", "c.txt"}));
    }
}

TEST(AtomicFile, TemporaryLiesBesideWithTheSameExtension) {
    const TemporaryFolder folder;
    const auto file = AtomicFile::create(folder.path() / "a.b.png");
    ASSERT_TRUE(file);
    EXPECT_EQ(file->temporary().parent_path(), folder.path());
    EXPECT_EQ(file->temporary().extension(), ".png");
}

TEST(AtomicFile, TwoForOneTargetDoNotMeet) {
    const TemporaryFolder folder;
    auto first = AtomicFile::create(folder.path() / "a.txt");
    auto second = AtomicFile::create(folder.path() / "a.txt");
    ASSERT_TRUE(first && second);
    EXPECT_NE(first->temporary(), second->temporary());
}

TEST(AtomicFile, MovedFromRemovesNothing) {
    const TemporaryFolder folder;
    auto first = AtomicFile::create(folder.path() / "a.txt");
    auto second = AtomicFile::create(folder.path() / "b.txt");
    ASSERT_TRUE(first && second);
    {
        AtomicFile taken = *std::move(first);
        taken = *std::move(second);
        EXPECT_EQ(folder.names().size(), 1U) << "the one assigned over is gone";
        EXPECT_TRUE(taken.commit());
    }
    EXPECT_THAT(folder.names(), ElementsAre("b.txt"));
}

TEST(AtomicFile, MissingFolderIsNamed) {
    const TemporaryFolder folder;
    const auto file = AtomicFile::create(folder.path() / "none" / "a.txt");
    ASSERT_FALSE(file);
    EXPECT_THAT(file.error().message,
                AllOf(HasSubstr("none/a.txt: cannot be written"), HasSubstr("there is no folder")));
}

TEST(AtomicFile, UnwritableFolderIsAnErrorEvenForRoot) {
    const auto file = AtomicFile::create("/proc/reljef.txt");
    ASSERT_FALSE(file);
    EXPECT_THAT(file.error().message, HasSubstr("/proc/reljef.txt: cannot be written"));
}

TEST(AtomicFile, FolderOrEmptyNameIsNoTarget) {
    const TemporaryFolder folder;
    EXPECT_FALSE(AtomicFile::create(folder.path()));
    EXPECT_FALSE(AtomicFile::create(folder.path() / ""));
    EXPECT_FALSE(AtomicFile::create(""));
    EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(AtomicFile, DeviceIsNotReplaced) {
    const auto file = AtomicFile::create("/dev/null");
    ASSERT_FALSE(file);
    EXPECT_THAT(file.error().message, HasSubstr("it is a device, a file was expected"));
}

TEST(AtomicFile, TargetThatBecameAFolderFailsCleanly) {
    const TemporaryFolder folder;
    {
        auto file = AtomicFile::create(folder.path() / "a.txt");
        ASSERT_TRUE(file);
        std::filesystem::create_directory(folder.path() / "a.txt");
        const auto committed = file->commit();
        ASSERT_FALSE(committed);
        EXPECT_THAT(committed.error().message, HasSubstr("a.txt: cannot be written"));
    }
    EXPECT_THAT(folder.names(), ElementsAre("a.txt"));
}

// In a child process, whose files may not grow beyond 4096 bytes.
TEST(AtomicFileDeathTest, FullDiskLeavesNothingBehind) {
    const TemporaryFolder folder;
    const auto write_too_much = [&] {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{4096, 4096};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        const auto written =
            write_text_file(folder.path() / "a.txt", std::string(std::size_t{1} << 20, 'x'));
        std::_Exit(written ? 1 : 0);
    };
    EXPECT_EXIT(write_too_much(), testing::ExitedWithCode(0), "");
    EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(TextFile, BytesSurviveTheRoundTrip) {
    const TemporaryFolder folder;
    std::string text("line\r\n\0\xff", 8);
    text += std::string(200000, 'y');
    ASSERT_TRUE(write_text_file(folder.path() / "a", text));
    const auto read = read_text_file(folder.path() / "a");
    ASSERT_TRUE(read);
    EXPECT_EQ(*read, text);
}

TEST(TextFile, LimitIsTheLargestSizeTaken) {
    const TemporaryFolder folder;
    const auto path = folder.write("a", std::string(1000, 'x'));
    EXPECT_TRUE(read_text_file(path, 1000));
    const auto read = read_text_file(path, 999);
    ASSERT_FALSE(read);
    EXPECT_THAT(read.error().message, HasSubstr("holds over 999 bytes"));
}

TEST(TextFile, EndlessDeviceStopsAtTheLimit) {
    EXPECT_FALSE(read_text_file("/dev/zero"));
}

TEST(TextFile, APipeThatNobodyWritesToIsRefusedAtOnce) {
    const TemporaryFolder folder;
    const auto pipe = folder.path() / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const auto read = read_text_file(pipe);
    ASSERT_FALSE(read);
    EXPECT_THAT(read.error().message, HasSubstr("pipe: is no regular file"));
}

TEST(TextFile, MissingFileAndFolderAreTold) {
    const TemporaryFolder folder;
    const auto missing = read_text_file(folder.path() / "none");
    ASSERT_FALSE(missing);
    EXPECT_THAT(missing.error().message, HasSubstr("none: cannot be read: No such file"));
    const auto directory = read_text_file(folder.path());
    ASSERT_FALSE(directory);
    EXPECT_THAT(directory.error().message, HasSubstr("is a folder, a file was expected"));
}

} // namespace
} // namespace reljef
