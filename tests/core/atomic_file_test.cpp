#include "engine/core/atomic_file.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <functional>
#include <set>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/temporary_folder.h"

// What is synced and renamed, in this order. The names replace those of the C library.
static std::vector<std::string>* observed = nullptr;

extern "C" int fsync(int file) {
    struct stat status {};
    if (observed != nullptr && ::fstat(file, &status) == 0) {
        observed->emplace_back(S_ISDIR(status.st_mode) ? "sync folder" : "sync file");
    }
    return static_cast<int>(::syscall(SYS_fsync, file));
}

// What another process would do while the files are in their places.
static std::function<void()>* during_rename = nullptr;

extern "C" int rename(const char* from, const char* to) noexcept {
    if (during_rename != nullptr) {
        (*during_rename)();
    }
    if (observed != nullptr) {
        observed->emplace_back("rename");
    }
    return static_cast<int>(::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}

namespace reljef {
namespace {

namespace fs = std::filesystem;

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

// A name as killed processes leave it.
std::string stale_name() {
    const TemporaryFolder folder;
    const auto file = AtomicFile::create(folder.path() / "a.png");
    EXPECT_TRUE(file);
    return file ? file->temporary().filename().string() : "";
}

TEST(AtomicFile, PowerFailureFindsTheOldOrTheNewFile) {
    const TemporaryFolder folder;
    std::vector<std::string> events;
    observed = &events;
    const auto written = write_text_file(folder.path() / "a.txt", "new");
    observed = nullptr;
    ASSERT_TRUE(written);
    EXPECT_THAT(events, ElementsAre("sync file", "rename", "sync folder"));
}

TEST(CommitAll, SyncsAllFilesBeforeTheFirstIsRenamed) {
    const TemporaryFolder folder;
    std::vector<AtomicFile> files;
    for (const char* const name : {"a.txt", "b.txt"}) {
        auto file = AtomicFile::create(folder.path() / name);
        ASSERT_TRUE(file);
        files.push_back(std::move(*file));
    }
    std::vector<std::string> events;
    observed = &events;
    const auto committed = commit_all(files);
    observed = nullptr;
    ASSERT_TRUE(committed);
    EXPECT_THAT(events, ElementsAre("sync file", "sync file", "rename", "rename", "sync folder"));
}

// Also of a file that another program has locked.
TEST(CommitAll, OldFilesAreNoLeftoversForOthersWhileTheyAreReplaced) {
    for (const bool is_locked : {false, true}) {
        const TemporaryFolder folder;
        const fs::path old = folder.write("a.txt", "old");
        const Descriptor users_own(::open(old.c_str(), O_RDONLY | O_CLOEXEC));
        ASSERT_EQ(::flock(users_own.number(), is_locked ? LOCK_EX : LOCK_UN), 0);
        auto first = AtomicFile::create(old);
        auto second = AtomicFile::create(folder.path() / "b.txt");
        ASSERT_TRUE(first && second);
        std::vector<AtomicFile> files;
        files.push_back(std::move(*first));
        files.push_back(std::move(*second));
        std::function<void()> clean = [&] { // another lock than ours, as of another process
            ::flock(users_own.number(), LOCK_UN);
            remove_leftovers(folder.path());
            std::error_code ignored;
            fs::create_directories(folder.path() / "b.txt" / "in", ignored); // the second fails
        };
        during_rename = &clean;
        const auto committed = commit_all(files);
        during_rename = nullptr;
        EXPECT_FALSE(committed);
        files.clear();
        EXPECT_EQ(read_bytes(old), "old");
        EXPECT_THAT(folder.names(), ElementsAre("a.txt", "b.txt"));
    }
}

TEST(AtomicFileDeathTest, TheOldFilesOfAKilledCommitAreRemovedByTheNext) {
    const TemporaryFolder folder;
    const fs::path old = folder.write("a.txt", "old");
    const auto die = [&] {
        auto file = AtomicFile::create(old);
        std::function<void()> kill = [] { ::kill(::getpid(), SIGKILL); };
        during_rename = &kill;
        static_cast<void>(commit_all(std::span(&*file, 1)));
    };
    EXPECT_EXIT(die(), testing::KilledBySignal(SIGKILL), "");
    EXPECT_EQ(folder.names().size(), 3U);
    remove_leftovers(folder.path());
    EXPECT_THAT(folder.names(), ElementsAre("a.txt"));
    EXPECT_EQ(read_bytes(old), "old");
}

TEST(AtomicFile, TemporaryNamesCannotBeGuessed) {
    const TemporaryFolder folder;
    std::set<std::string> names;
    std::set<std::string> starts; // counters and times share their first digits
    for (int i = 0; i < 64; ++i) {
        const auto file = AtomicFile::create(folder.path() / "a.txt");
        ASSERT_TRUE(file);
        const std::string name = file->temporary().filename().string();
        names.insert(name);
        starts.insert(name.substr(std::string(".reljef-").size(), 4));
    }
    EXPECT_EQ(names.size(), 64U);
    EXPECT_GT(starts.size(), 50U) << "64 of 65536: a collision of two is likely in 3 of 100 runs";
}

TEST(AtomicFile, ALinkInPlaceOfTheTemporaryIsNeitherWrittenThroughNorCommitted) {
    const TemporaryFolder folder;
    const fs::path victim = folder.write("victim", "untouched");
    auto file = AtomicFile::create(folder.path() / "a.txt");
    ASSERT_TRUE(file);
    fs::remove(file->temporary());
    fs::create_symlink(victim, file->temporary());
    EXPECT_TRUE(file->write(std::as_bytes(std::span(std::string_view("new")))));
    EXPECT_FALSE(file->commit());
    EXPECT_EQ(read_bytes(victim), "untouched");
    EXPECT_FALSE(fs::exists(folder.path() / "a.txt"));
}

TEST(AtomicFile, ALinkStaysAndItsTargetIsReplaced) {
    const TemporaryFolder folder;
    folder.write("below/a.txt", "old");
    fs::create_symlink("below/a.txt", folder.path() / "link.txt");
    fs::create_symlink(folder.path() / "link.txt", folder.path() / "below/second.txt");
    for (const char* const name : {"link.txt", "below/second.txt"}) {
        ASSERT_TRUE(write_text_file(folder.path() / name, name));
        EXPECT_TRUE(fs::is_symlink(folder.path() / name));
        EXPECT_EQ(read_bytes(folder.path() / "below/a.txt"), name);
    }
}

TEST(AtomicFile, ADanglingLinkMakesItsTarget) {
    const TemporaryFolder folder;
    folder.write("below/other", "");
    fs::create_symlink("below/a.txt", folder.path() / "link.txt");
    ASSERT_TRUE(write_text_file(folder.path() / "link.txt", "new"));
    EXPECT_TRUE(fs::is_symlink(folder.path() / "link.txt"));
    EXPECT_EQ(read_bytes(folder.path() / "below/a.txt"), "new");
    fs::create_symlink("nowhere/a.txt", folder.path() / "lost.txt");
    const auto lost = write_text_file(folder.path() / "lost.txt", "new");
    ASSERT_FALSE(lost);
    EXPECT_THAT(lost.error().message, HasSubstr("lost.txt: cannot be written: No such file"));
}

TEST(AtomicFile, ACircleOfLinksAndALinkToADeviceAreRefused) {
    const TemporaryFolder folder;
    fs::create_symlink("b.txt", folder.path() / "a.txt");
    fs::create_symlink("a.txt", folder.path() / "b.txt");
    const auto circle = AtomicFile::create(folder.path() / "a.txt");
    ASSERT_FALSE(circle);
    EXPECT_THAT(circle.error().message, HasSubstr("a.txt: cannot be written: Too many levels"));
    fs::create_symlink("/dev/null", folder.path() / "null");
    EXPECT_FALSE(AtomicFile::create(folder.path() / "null"));
}

TEST(AtomicFile, TheUmaskDecidesWhoReadsTheFile) {
    const TemporaryFolder folder;
    const mode_t before = ::umask(0027);
    const auto written = write_text_file(folder.path() / "a.txt", "x");
    ::umask(before);
    ASSERT_TRUE(written);
    EXPECT_EQ(fs::status(folder.path() / "a.txt").permissions(), fs::perms(0640));
}

// Of a process that is killed while it writes.
TEST(AtomicFileDeathTest, WhatAKilledProcessLeftIsRemovedByTheNext) {
    const TemporaryFolder folder;
    const auto die = [&] {
        const auto file = AtomicFile::create(folder.path() / "a.txt");
        const auto scratch = ScratchFolder::create(folder.path());
        std::ofstream(scratch->path() / "inside") << "x";
        ::kill(::getpid(), SIGKILL);
    };
    EXPECT_EXIT(die(), testing::KilledBySignal(SIGKILL), "");
    EXPECT_EQ(folder.names().size(), 2U);
    remove_leftovers(folder.path());
    EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(AtomicFile, WhatALivingProcessWritesIsNotStale) {
    const TemporaryFolder folder;
    const auto first = AtomicFile::create(folder.path() / "a.txt");
    const auto scratch = ScratchFolder::create(folder.path());
    ASSERT_TRUE(first && scratch);
    remove_leftovers(folder.path());
    EXPECT_EQ(folder.names().size(), 2U);
}

TEST(AtomicFile, FilesAndFoldersOfAUserWithSimilarNamesAreNotStale) {
    const TemporaryFolder folder;
    const std::string ours = stale_name();
    const std::string stem = fs::path(ours).stem().string();
    std::string upper = ours;
    upper[8] = 'A';
    std::vector<std::string> kept{".reljef-0123456789abcdef",
                                  ".reljef-0123456789abcdef.part",
                                  ".reljef-0000000000000000.part.png",
                                  ".reljef-ZZZZZZZZZZZZZZZZ.part",
                                  ".reljef-holiday-pictures.part.jpg",
                                  ".reljef-notes.part.txt",
                                  ".reljef-.part",
                                  ours.substr(1),
                                  ours + ".bak",
                                  stem + "ners.txt",
                                  upper};
    for (const std::string& name : kept) {
        folder.write(name, "mine");
    }
    for (const char* const name : {".reljef-my-project-file0.part", ".reljef-folder.part"}) {
        fs::create_directory(folder.path() / kept.emplace_back(name));
    }
    fs::create_directory(folder.path() / kept.emplace_back(stem + ".d"));
    folder.write(ours, "stale");
    remove_leftovers(folder.path());
    EXPECT_THAT(folder.names(), testing::UnorderedElementsAreArray(kept));
}

TEST(AtomicFile, AStaleNameThatIsALinkAPipeOrForeignStays) {
    if (::geteuid() != 0) {
        GTEST_SKIP() << "only root can give files away";
    }
    const TemporaryFolder folder;
    const fs::path victim = folder.write("victim/a", "untouched").parent_path();
    const std::string name = stale_name();
    const fs::path stale = folder.path() / name;
    const auto expect_kept = [&] {
        remove_leftovers(folder.path());
        EXPECT_TRUE(fs::exists(fs::symlink_status(stale)));
        fs::remove(stale);
    };
    fs::create_symlink(victim, stale);
    expect_kept();
    ASSERT_EQ(::mkfifo(stale.c_str(), 0600), 0);
    expect_kept();
    folder.write(name, "foreign");
    ASSERT_EQ(::chown(stale.c_str(), 12345, 12345), 0);
    expect_kept();
    EXPECT_EQ(read_bytes(victim / "a"), "untouched");
}

TEST(ScratchFolder, IsForThisUserOnlyAndGoesWithItsContent) {
    const TemporaryFolder folder;
    {
        const auto scratch = ScratchFolder::create(folder.path());
        ASSERT_TRUE(scratch);
        EXPECT_EQ(fs::status(scratch->path()).permissions(), fs::perms(0700));
        fs::create_directory(scratch->path() / "below");
        std::ofstream(scratch->path() / "below" / "a") << "x";
        errno = ENOSPC;
    }
    EXPECT_EQ(errno, ENOSPC);
    EXPECT_THAT(folder.names(), IsEmpty());
    const auto nowhere = ScratchFolder::create(folder.path() / "none");
    ASSERT_FALSE(nowhere);
    EXPECT_THAT(nowhere.error().message, HasSubstr("no folder can be made in it: No such file"));
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
