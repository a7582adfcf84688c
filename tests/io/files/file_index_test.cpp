#include "engine/io/files/file_index.h"

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "engine/core/atomic_file.h"
#include "engine/io/cache/fnv_hash.h"
#include "tests/io/made_raster.h"
#include "tests/support/plain_permissions.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using ::testing::HasSubstr;

constexpr const char* grid_text = "ncols 3\nnrows 3\nxllcorner 500000\nyllcorner 5000000\n"
                                  "cellsize 10\n1 2 3\n4 5 6\n7 8 9\n";

/// The WKT of UTM 31, as files beside rasters have it.
std::string utm31_text() {
    OGRSpatialReference crs;
    crs.importFromEPSG(32631);
    char* text = nullptr;
    crs.exportToWkt(&text);
    std::string wkt = text;
    CPLFree(text);
    return wkt;
}

class TileIndices : public ::testing::Test {
protected:
    void raster(const std::string& name, bool placed) const {
        auto made = test::made_raster(4, 4, [](int col, int) { return col; });
        made.crs = "EPSG:32631";
        if (placed) {
            made.geotransform = {500000.0, 10.0, 0.0, 5000000.0, 0.0, -10.0};
        }
        ASSERT_TRUE(test::write(made, folder_.path() / name));
    }
    [[nodiscard]] FileIndex index() const {
        std::vector<std::string> notes;
        auto found = index_files(folder_.path(), options_, notes);
        EXPECT_TRUE(found) << (found ? "" : found.error().message);
        EXPECT_EQ(test::joined(notes), "");
        return found ? std::move(*found) : FileIndex{};
    }
    /// Of the only file; empty where it is usable.
    [[nodiscard]] std::string error() const {
        const FileIndex found = index();
        EXPECT_EQ(found.files.size(), 1U);
        return found.files.empty() ? "no file" : found.files.front().error;
    }
    /// The index that is kept says of every file that its format is "kept".
    void mark_what_is_kept() const {
        FileIndex marked = index();
        for (IndexedFile& file : marked.files) {
            file.format = "kept";
        }
        const std::filesystem::path kept = *std::filesystem::directory_iterator(cache_.path());
        ASSERT_TRUE(write_text_file(kept, bytes_of(marked)));
    }
    void remove(const std::string& name) const { std::filesystem::remove(folder_.path() / name); }

    const test::TemporaryFolder folder_;
    const test::TemporaryFolder cache_;
    const FileIndexOptions options_{cache_.path(), 0, false, {}, {}};
};

TEST_F(TileIndices, SeeASystemThatIsAddedBesideAFileAndTakenAway) {
    folder_.write("a.asc", grid_text);
    EXPECT_THAT(error(), HasSubstr("names no place on Earth"));
    folder_.write("a.prj", utm31_text());
    EXPECT_EQ(error(), "");
    remove("a.prj");
    EXPECT_THAT(error(), HasSubstr("names no place on Earth"));
}

TEST_F(TileIndices, SeeAPlaceThatIsAddedBesideAFileAndChanged) {
    raster("a.tif", false);
    EXPECT_THAT(error(), HasSubstr("names no place on Earth"));
    folder_.write("a.tfw", "10\n0\n0\n-10\n500005\n4999995\n");
    EXPECT_EQ(index().files.front().crs_from_pixel.x0, 500000.0);
    folder_.write("a.tfw", "10\n0\n0\n-10\n1500005\n4999995\n");
    EXPECT_EQ(index().files.front().crs_from_pixel.x0, 1500000.0);
}

TEST_F(TileIndices, TakeWhatLiesBesideOneFileForNoReasonToReadAnother) {
    for (const char* name : {"a.tif", "b.tif", "sub/a.tif"}) {
        std::filesystem::create_directories((folder_.path() / name).parent_path());
        raster(name, true);
    }
    for (const char* beside : {"b.prj", "b.TFW", "b.tif.aux.xml", "b.tif.ovr", "b.tif.msk", "b.hdr",
                               "b.wld", "B.tifw"}) {
        mark_what_is_kept();
        folder_.write(beside, "");
        const FileIndex found = index();
        ASSERT_EQ(found.files.size(), 3U);
        EXPECT_EQ(found.files[0].format, "kept") << beside;
        EXPECT_EQ(found.files[1].format, "GTiff") << beside;
        EXPECT_EQ(found.files[2].format, "kept") << beside;
    }
}

TEST_F(TileIndices, ReadAGridOfManyFilesAgainWhereOneOfThemChanges) {
    for (const char* name : {"grid/w001001.adf", "grid/hdr.adf"}) {
        folder_.write(name, "x");
    }
    const FileIndex before = index();
    folder_.write("grid/prj.adf", "Projection UTM");
    const FileIndex after = index();
    EXPECT_NE(before.files.back().sidecar_hash, after.files.back().sidecar_hash);
}

// A checksum is right for whatever was written.
TEST_F(TileIndices, NonsenseBehindAValidChecksumIsFound) {
    raster("a.tif", true);
    raster("b.tif", true);
    const FileIndex good = index();
    ASSERT_TRUE(index_from_bytes(bytes_of(good)));
    const std::vector<std::function<void(FileIndex&)>> changes{
        [](FileIndex& bad) { bad.files[0].use = static_cast<FileKind>(3); },
        [](FileIndex& bad) { bad.files[0].crs = static_cast<int>(bad.crs.size()); },
        [](FileIndex& bad) { bad.files[0].crs = -1; },
        [](FileIndex& bad) { bad.files[0].cols = 1; },
        [](FileIndex& bad) { bad.files[0].rows = std::numeric_limits<int>::max(); },
        [](FileIndex& bad) {
            bad.files[0].use = FileKind::picture;
            bad.files[0].rows = -1;
        },
        [](FileIndex& bad) { bad.files[0].crs_from_pixel.x0 = NAN; },
        [](FileIndex& bad) { bad.files[0].crs_from_pixel.x_col = 0.0; },
        [](FileIndex& bad) { bad.files[0].opened = false; },
        [](FileIndex& bad) { bad.files[0].error = "unusable"; },
        [](FileIndex& bad) { bad.files[1].path = bad.files[0].path; },
        [](FileIndex& bad) { std::swap(bad.files[0], bad.files[1]); },
        [](FileIndex& bad) { bad.files[0].path = ""; },
        [](FileIndex& bad) { bad.crs.push_back(bad.crs[0]); },
        [](FileIndex& bad) { bad.crs.clear(); },
    };
    for (std::size_t i = 0; i < changes.size(); ++i) {
        FileIndex bad = good;
        changes[i](bad);
        EXPECT_FALSE(index_from_bytes(bytes_of(bad))) << "change " << i;
    }
}

// A bool that is neither 0 nor 1 would be undefined behaviour.
TEST_F(TileIndices, ABoolIsNoOtherByte) {
    raster("a.tif", true);
    FileIndex good = index();
    good.files[0].declares_voids = true;
    std::string bytes = bytes_of(good);
    ASSERT_EQ(bytes.back(), 1);
    bytes.back() = 2;
    constexpr std::size_t head = 20; // magic
    const std::uint64_t checksum = fnv_hash(std::string_view(bytes).substr(head + 8));
    std::memcpy(bytes.data() + head, &checksum, sizeof(checksum));
    EXPECT_FALSE(index_from_bytes(bytes));
    bytes.back() = 0;
    const std::uint64_t other = fnv_hash(std::string_view(bytes).substr(head + 8));
    std::memcpy(bytes.data() + head, &other, sizeof(other));
    EXPECT_TRUE(index_from_bytes(bytes));
}

TEST_F(TileIndices, PlacesThatAreNotThoseOfTheFilesAreFound) {
    raster("a.tif", true);
    raster("b.tif", true);
    FileIndex moved = index();
    const double x0 = moved.files[1].crs_from_pixel.x0;
    moved.files[1].crs_from_pixel.x0 += 10.0;
    const std::filesystem::path kept = *std::filesystem::directory_iterator(cache_.path());
    ASSERT_TRUE(write_text_file(kept, bytes_of(moved)));
    std::vector<std::string> notes;
    const auto found = index_files(folder_.path(), options_, notes);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->files[1].crs_from_pixel.x0, x0);
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_THAT(notes[0],
                HasSubstr("holds nonsense of the files: the source files are indexed anew"));
    EXPECT_EQ(index(), *found) << "the cache is right again";
}

// Four of 16 files are opened. Nonsense of one file escapes 64 times with a chance of 1e-8.
TEST_F(TileIndices, NonsenseOfNoFileEscapesForEver) {
    for (int i = 0; i < 16; ++i) {
        raster(fmt::format("{:02d}.tif", i), true);
    }
    const FileIndex good = index();
    const std::filesystem::path kept = *std::filesystem::directory_iterator(cache_.path());
    for (const std::size_t wrong : {1U, 15U}) {
        std::vector<std::string> notes;
        for (int i = 1; i <= 64 && notes.empty(); ++i) {
            FileIndex moved = good;
            moved.files[wrong].crs_from_pixel.x0 += 10.0 * i;
            ASSERT_TRUE(write_text_file(kept, bytes_of(moved)));
            ASSERT_TRUE(index_files(folder_.path(), options_, notes));
        }
        EXPECT_EQ(notes.size(), 1U) << wrong;
    }
}

TEST_F(TileIndices, ACacheThatIsAPipeALinkOrForeignCostsOnlySpeed) {
    raster("a.tif", true);
    const FileIndex good = index();
    const std::filesystem::path kept = *std::filesystem::directory_iterator(cache_.path());
    const auto expect_note = [&](const std::string& why) {
        std::vector<std::string> notes;
        const auto found = index_files(folder_.path(), options_, notes);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->files[0].crs_from_pixel, good.files[0].crs_from_pixel);
        ASSERT_EQ(notes.size(), 1U);
        EXPECT_THAT(notes[0], HasSubstr(why));
    };
    std::filesystem::remove(kept);
    ASSERT_EQ(::mkfifo(kept.c_str(), 0600), 0);
    expect_note("no regular file found");
    std::filesystem::remove(kept);
    std::filesystem::create_symlink("/dev/zero", kept);
    expect_note("a link found");
    std::filesystem::permissions(cache_.path(), std::filesystem::perms::all);
    expect_note("other users can write to it");
}

TEST_F(TileIndices, ACacheThatCannotBeWrittenIsNotedOnce) {
    raster("a.tif", true);
    const test::PlainPermissions plain;
    std::filesystem::permissions(cache_.path(), std::filesystem::perms::owner_write,
                                 std::filesystem::perm_options::remove);
    std::vector<std::string> notes;
    EXPECT_TRUE(index_files(folder_.path(), options_, notes));
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_THAT(notes[0], HasSubstr(cache_.path().string()));
    EXPECT_THAT(notes[0], HasSubstr("the source files are indexed anew at each start"));
    std::filesystem::permissions(cache_.path(), std::filesystem::perms::owner_all);
    EXPECT_EQ(index().files.size(), 1U) << "without a note";
}

TEST_F(TileIndices, KeepNoFaultOfOpening) {
    raster("a.tif", true);
    const auto file = folder_.path() / "a.tif";
    const test::PlainPermissions plain;
    std::filesystem::permissions(file, std::filesystem::perms::none);
    EXPECT_THAT(error(), HasSubstr("Permission denied"));
    std::filesystem::permissions(file, std::filesystem::perms::owner_read);
    EXPECT_EQ(error(), "");
}

TEST_F(TileIndices, NameAFolderThatCannotBeReadButPassOverThoseInIt) {
    raster("a.tif", true);
    std::filesystem::create_directory(folder_.path() / "closed");
    const test::PlainPermissions plain;
    std::filesystem::permissions(folder_.path() / "closed", std::filesystem::perms::none);
    EXPECT_EQ(error(), "");
    const auto before = std::filesystem::status(folder_.path()).permissions();
    std::filesystem::permissions(folder_.path(), std::filesystem::perms::none);
    std::vector<std::string> notes;
    const auto closed = index_files(folder_.path(), options_, notes);
    std::filesystem::permissions(folder_.path(), before);
    ASSERT_FALSE(closed);
    EXPECT_THAT(closed.error().message, HasSubstr("cannot be read (Permission denied)"));
}

TEST_F(TileIndices, PassOverWhatCannotBeReadAndMayBeNoRaster) {
    raster("a.tif", true);
    folder_.write("N45E006.raw", std::string(2048, 'x'));
    folder_.write("letter", "To whom it may concern");
    const test::PlainPermissions plain;
    for (const char* name : {"N45E006.raw", "letter"}) {
        std::filesystem::permissions(folder_.path() / name, std::filesystem::perms::none);
    }
    EXPECT_EQ(error(), "");
}

} // namespace
} // namespace reljef::io
