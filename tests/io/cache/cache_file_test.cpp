#include "engine/io/cache/cache_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/plain_permissions.h"
#include "tests/support/process_state.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class DiskCache : public testing::Test {
protected:
    [[nodiscard]] Result<void> write(std::string_view text = "new") const {
        return write_cache_file(file_, {std::as_bytes(std::span(text))});
    }
    // Neither read nor replaced.
    void expect_left_alone(const std::string& why) const {
        const auto found = read_cache_file(file_, 100);
        ASSERT_FALSE(found);
        EXPECT_THAT(found.error().message, HasSubstr(why));
        const auto written = write();
        ASSERT_FALSE(written);
        EXPECT_THAT(written.error().message, HasSubstr(why));
    }

    test::TemporaryFolder folder_;
    const fs::path cache_ = folder_.path() / "cache";
    const fs::path file_ = cache_ / "a.cones";
};

TEST_F(DiskCache, IsForThisUserOnly) {
    const auto none = read_cache_file(file_, 100);
    ASSERT_TRUE(none);
    EXPECT_FALSE(*none);
    const mode_t before = ::umask(0);
    const auto written = write();
    ::umask(before);
    ASSERT_TRUE(written) << written.error().message;
    EXPECT_EQ(fs::status(cache_).permissions(), fs::perms(0700));
    EXPECT_EQ(fs::status(file_).permissions(), fs::perms(0600));
    EXPECT_EQ(read_cache_file(file_, 3).value(), "new");
}

TEST_F(DiskCache, AFileLongerThanExpectedIsNotRead) {
    ASSERT_TRUE(write("too long"));
    const auto found = read_cache_file(file_, 7);
    ASSERT_FALSE(found);
    EXPECT_THAT(found.error().message, HasSubstr("a length of 8 bytes found"));
    EXPECT_TRUE(write()) << "but it is replaced";
}

// Opening a pipe without a writer waits for one.
TEST_F(DiskCache, AFifoInTheCacheFolderDoesNotBlock) {
    fs::create_directory(cache_);
    ASSERT_EQ(::mkfifo(file_.c_str(), 0600), 0);
    expect_left_alone("a.cones: no regular file found");
}

TEST_F(DiskCache, ALinkIsNotFollowed) {
    const fs::path other = folder_.write("other", "another's");
    fs::create_directory(cache_);
    fs::create_symlink(other, file_);
    expect_left_alone("a.cones: a link found");
    fs::remove(file_);
    fs::create_symlink("nowhere", file_);
    expect_left_alone("a.cones: a link found");
    EXPECT_EQ(test::read_bytes(other), "another's");
    EXPECT_FALSE(fs::exists(cache_ / "nowhere"));
}

TEST_F(DiskCache, AForeignFileOrFolderIsNotUsed) {
    if (::geteuid() != 0) {
        GTEST_SKIP() << "only root can give files away";
    }
    ASSERT_TRUE(write("old"));
    ASSERT_EQ(::chown(file_.c_str(), 12345, 12345), 0);
    expect_left_alone("a.cones: another user owns it");
    fs::remove(file_);
    ASSERT_EQ(::chown(cache_.c_str(), 12345, 12345), 0);
    expect_left_alone("cache: another user owns it");
    EXPECT_TRUE(fs::is_empty(cache_));
}

TEST_F(DiskCache, WhatOthersCanWriteToIsNotUsed) {
    ASSERT_TRUE(write("old"));
    fs::permissions(file_, fs::perms(0660));
    expect_left_alone("a.cones: other users can write to it");
    fs::permissions(file_, fs::perms(0600));
    fs::permissions(cache_, fs::perms(0777));
    expect_left_alone("cache: other users can write to it");
    fs::permissions(cache_, fs::perms(01777)); // sticky: others cannot replace the file
    EXPECT_EQ(read_cache_file(file_, 100).value(), "old");
}

TEST_F(DiskCache, AFileInPlaceOfTheFolderIsAnError) {
    folder_.write("cache", "a file");
    expect_left_alone("cache: cannot be used: Not a directory");
}

TEST_F(DiskCache, AReadOnlyFolderIsAnErrorOfWriting) {
    ASSERT_TRUE(write("old"));
    const test::PlainPermissions plain;
    fs::permissions(cache_, fs::perms(0500));
    const auto written = write();
    ASSERT_FALSE(written);
    EXPECT_THAT(written.error().message, HasSubstr("cannot be written: Permission denied"));
    EXPECT_EQ(read_cache_file(file_, 100).value(), "old");
    fs::permissions(cache_, fs::perms(0700));
}

TEST_F(DiskCache, AFullDiskLeavesNoPart) {
    ASSERT_TRUE(write("old"));
    {
        const test::FileSizeLimit limit(1000);
        EXPECT_FALSE(write(std::string(5000, 'x')));
    }
    EXPECT_EQ(read_cache_file(file_, 100).value(), "old");
    EXPECT_THAT(std::vector<fs::path>(fs::directory_iterator(cache_), {}), ElementsAre(file_));
}

} // namespace
} // namespace reljef::io
