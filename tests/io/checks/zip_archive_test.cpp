#include "engine/io/checks/zip_archive.h"

#include <cstddef>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/raster/raster.h"
#include "tests/io/made_raster.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class ZipArchives : public testing::Test {
protected:
    /// An archive with one member.
    [[nodiscard]] std::filesystem::path archive_with(const std::string& member) const {
        std::filesystem::path path = folder_.path() / "a.zip";
        std::filesystem::remove(path);
        EXPECT_TRUE(test::add_to_zip(path, member, "nothing"));
        return path;
    }
    [[nodiscard]] static std::string error_of(const std::filesystem::path& path) {
        const auto members = archive_members(path);
        return members ? "" : members.error().message;
    }
    /// With a list of a large archive (ZIP64), which counts before the other one.
    [[nodiscard]] static std::string with_long_list(const std::string& archive,
                                                    std::size_t members) {
        const auto word = [](std::size_t value) {
            std::string bytes;
            for (int i = 0; i < 8; ++i) {
                bytes += static_cast<char>(value >> (8 * i) & 0xFFU);
            }
            return bytes;
        };
        const auto end = archive.rfind("PK\5\6");
        const std::size_t list = archive.find("PK\1\2");
        const std::string record = "PK\6\6" + word(44) + std::string(12, '\0') + word(members) +
                                   word(members) + word(end - list) + word(list);
        return archive.substr(0, end) + record + "PK\6\7" + std::string(4, '\0') + word(end) +
               std::string("\1\0\0\0", 4) + archive.substr(end);
    }
    static std::string repeated(const std::string& text, int count) {
        std::string all;
        for (int i = 0; i < count; ++i) {
            all += text;
        }
        return all;
    }

    test::TemporaryFolder folder_;
};

TEST_F(ZipArchives, MembersHaveTheirPathAndANameForGdal) {
    const auto path = archive_with("a/b.tif");
    ASSERT_TRUE(test::add_to_zip(path, "c.kml", "nothing"));
    const auto members = archive_members(path);
    ASSERT_TRUE(members) << members.error().message;
    ASSERT_EQ(members->size(), 2U);
    EXPECT_EQ(members->front().path, "a/b.tif");
    EXPECT_EQ(members->back().name, "/vsizip/{" + path.string() + "}/c.kml");
    EXPECT_THAT(error_of(folder_.write("b.zip", "no archive")), HasSubstr("is no ZIP archive"));
    EXPECT_THAT(error_of(folder_.path() / "none.zip"), HasSubstr("is no ZIP archive"));
}

// GDAL keeps a name for each folder of each member: a gigabyte for 1.2 MB, or hours.
TEST_F(ZipArchives, LongOrDeepNamesAreRefused) {
    for (const auto& folders :
         {repeated("a/", 17), repeated("a\\", 17), std::string(300, 'a') + '/'}) {
        EXPECT_THAT(error_of(archive_with(folders + "a.tif")), HasSubstr("names of its members"));
    }
    EXPECT_EQ(error_of(archive_with(repeated("a/", 15) + "a.tif")), "");
}

TEST_F(ZipArchives, AnotherListOfNamesIsRefused) {
    const std::string good = test::read_bytes(archive_with("a.tif"));
    EXPECT_EQ(error_of(folder_.write("b.zip", with_long_list(good, 1))), "");
    EXPECT_THAT(error_of(folder_.write("b.zip", with_long_list(good, 2))),
                HasSubstr("names of its members"));
}

TEST_F(ZipArchives, ArchivesOfTypedNamesAreCheckedToo) {
    const std::string good = archive_with("a.tif").string();
    for (const std::string& name : {"/vsizip/" + good, "/vsizip/" + good + "/a.tif",
                                    "/vsizip/{" + good + "}/a.tif", std::string("a.tif")}) {
        EXPECT_TRUE(check_archives_of(name)) << name;
    }
    const std::string bad =
        folder_.write("b.zip", with_long_list(test::read_bytes(good), 2)).string();
    for (const std::string& name :
         {"/vsizip/" + bad, "/vsizip/" + bad + "/a.tif", "/vsizip/{" + bad + "}/a.tif",
          "/vsizip/{/vsizip/{" + bad + "}/inner.zip}/a.tif",
          "/vsizip//vsizip/" + bad + "/inner.zip/a.tif"}) {
        const auto checked = check_archives_of(name);
        ASSERT_FALSE(checked) << name;
        EXPECT_THAT(checked.error().message, StartsWith(bad + ": the names of its members"));
        EXPECT_FALSE(read_raster_info(name));
    }
    EXPECT_THAT(read_raster_info(bad).error().message, HasSubstr("names of its members"));
}

} // namespace
} // namespace reljef::io
