#include "engine/io/tree_tile.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/raster/crs_transform.h"
#include "tests/io/made_raster.h"
#include "tests/support/process_state.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

namespace reljef::io {
namespace {

using terrain::TileTree;
using terrain::TreeTile;

TileSet open_set(const std::filesystem::path& path) {
    auto tiles = TileSet::open(path);
    EXPECT_TRUE(tiles) << (tiles ? "" : tiles.error().message);
    return std::move(*tiles);
}

/// A raster in metres, UTM, as `made`.
test::MadeRaster placed(test::MadeRaster made, double step) {
    made.crs = "EPSG:32631";
    made.geotransform = {300000.0, step, 0.0, 5600000.0, 0.0, -step};
    return made;
}

TEST(TreeTiles, AreTheSamplesThemselvesAtTheFinestLevel) {
    const test::TemporaryFolder folder;
    const auto value = [](int col, int row) { return 7.0 * col - 3.0 * row; };
    ASSERT_TRUE(
        test::write(placed(test::made_raster(300, 200, value), 10.0), folder.path() / "a.tif"));
    const TileSet tiles = open_set(folder.path() / "a.tif");
    const TileTree tree(300, 200);
    for (const TreeTile tile : {TreeTile{0, 0, 0}, {0, 1, 1}, {0, 2, 1}}) {
        const auto heights = read_tree_tile(tiles, {tiles.grid()}, tree, tile, Gaps::holes).heights;
        for (int row = 0; row < heights.rows(); ++row) {
            for (int col = 0; col < heights.cols(); ++col) {
                const glm::ivec2 sample = tree.sample(tile, {col - 1, row - 1});
                ASSERT_EQ(heights(col, row), value(sample.x, sample.y));
            }
        }
    }
}

TEST(TreeTiles, OfALevelAgreeToTheLastBitWhereTheyMeet) {
    const test::TemporaryFolder folder;
    const auto value = [](int col, int row) {
        return 900.0 * std::sin(0.05 * col) * std::cos(0.07 * row) + 0.37 * col;
    };
    auto raster = placed(test::made_raster(1100, 1100, value), 10.0);
    raster.overviews = {2, 4};
    ASSERT_TRUE(test::write(raster, folder.path() / "a.tif"));
    const TileSet tiles = open_set(folder.path());
    const TileTree tree(1100, 1100);
    for (int level = 0; level < 3; ++level) {
        const auto west =
            read_tree_tile(tiles, {tiles.grid()}, tree, {level, 0, 1}, Gaps::holes).heights;
        const auto east =
            read_tree_tile(tiles, {tiles.grid()}, tree, {level, 1, 1}, Gaps::holes).heights;
        for (int row = 0; row < std::min(west.rows(), east.rows()); ++row) {
            for (int col = 0; col < 3; ++col) {
                const auto a = static_cast<float>(west(terrain::tree_tile_cells + col, row));
                const auto b = static_cast<float>(east(col, row));
                ASSERT_EQ(a, b) << "level " << level << " at " << col << "," << row;
            }
        }
    }
}

TEST(TreeTiles, NoStepAcrossTheEdgesOfTheAlpineBlock) {
    const test::TemporaryFolder folder;
    for (const char* name : {"N44E006.hgt", "N44E007.hgt", "N45E006.hgt", "N45E007.hgt"}) {
        const std::string file = std::string("natural/srtm3/") + name;
        RELJEF_NEED_DATA(file);
        std::filesystem::create_symlink(std::filesystem::absolute(test::data_path(file)),
                                        folder.path() / name);
    }
    const TileSet tiles = open_set(folder.path());
    const TileGrid grid = tiles.grid();
    ASSERT_EQ(grid.cols, 2401);
    const auto one = TileSet::open(folder.path() / "N45E006.hgt");
    const auto two = TileSet::open(folder.path() / "N45E007.hgt");
    ASSERT_TRUE(one && two);
    // The column that both have: the same from either, and from the set, to the last bit.
    const TileGrid shared{grid.first + grid.step * glm::dvec2(1200.0, 0.0), grid.step, 1, 1201};
    const auto a = one->read(shared, Gaps::holes).heights;
    EXPECT_EQ(a, two->read(shared, Gaps::holes).heights);
    EXPECT_EQ(a, tiles.read(shared, Gaps::holes).heights);
}

TEST(TreeTiles, LeaveNoFileOpenAndSpareTheRestOfAHugeRaster) {
    const test::TemporaryFolder folder;
    const auto value = [](int col, int row) { return static_cast<double>(col ^ row); };
    auto raster = placed(test::made_raster(256, 256, value), 10.0);
    ASSERT_TRUE(test::write(raster, folder.path() / "part.tif"));
    // 65536² samples: the same part everywhere, with overviews that GDAL makes as it reads.
    folder.write("huge.vrt", test::stretched_vrt("part.tif", {.step = 10.0,
                                                              .type = "Float32",
                                                              .overviews = "2 4 8 16 32 64 128 256 "
                                                                           "512"}));
    const std::size_t before = test::open_files();
    {
        const TileSet tiles = open_set(folder.path() / "huge.vrt");
        const TileTree tree(65536, 65536);
        std::size_t bytes_read = 0;
        for (int level = tree.root().level; level >= 0; --level) {
            const TreeTile tile{level, (1 << (tree.root().level - level)) / 3, 0};
            const auto window = read_tree_tile(tiles, {tiles.grid()}, tree, tile, Gaps::holes);
            ASSERT_TRUE(window.errors.empty());
            ASSERT_FALSE(std::isnan(window.heights(60, 60)));
            bytes_read += window.bytes_read;
        }
        EXPECT_LT(bytes_read, std::size_t{64} << 20);
        EXPECT_LT(test::open_files(), before + 8);
    }
    EXPECT_EQ(test::open_files(), before);
}

TEST(TreeTiles, TellTheCommandThatMakesOverviews) {
    const test::TemporaryFolder folder;
    auto raster = placed(test::made_raster(9000, 4, [](int col, int) { return col; }), 10.0);
    raster.type = GDT_Int16;
    ASSERT_TRUE(test::write(raster, folder.path() / "long.tif"));
    const auto told = missing_overviews(open_set(folder.path() / "long.tif"));
    ASSERT_TRUE(told);
    EXPECT_THAT(*told, ::testing::HasSubstr("long.tif"));
    EXPECT_THAT(*told, ::testing::HasSubstr("gdaladdo -r average "));
}

TEST(TreeTiles, AFileReplacedWhileItIsOpenIsReadAnew) {
    const test::TemporaryFolder folder;
    const auto file = folder.path() / "a.tif";
    const auto write = [&](double height) {
        ASSERT_TRUE(test::write(
            placed(test::made_raster(100, 100, [&](int, int) { return height; }), 10.0), file));
    };
    write(1.0);
    const TileSet tiles = open_set(file);
    const TileTree tree(100, 100);
    const auto height = [&] {
        return read_tree_tile(tiles, {tiles.grid()}, tree, {0, 0, 0}, Gaps::holes).heights(50, 50);
    };
    EXPECT_EQ(height(), 1.0);
    write(2.0);
    std::filesystem::last_write_time(file, std::filesystem::last_write_time(file) +
                                               std::chrono::seconds(2));
    EXPECT_EQ(height(), 2.0);
    std::filesystem::resize_file(file, 200);
    std::filesystem::last_write_time(file, std::filesystem::last_write_time(file) +
                                               std::chrono::seconds(4));
    const auto cut = read_tree_tile(tiles, {tiles.grid()}, tree, {0, 0, 0}, Gaps::holes);
    ASSERT_EQ(cut.errors.size(), 1U);
    EXPECT_THAT(cut.errors.front().message, ::testing::HasSubstr("a.tif"));
}

/// A plane over the same square kilometre, in samples of 10 m where it is first read.
class ReplacedTile : public ::testing::Test {
protected:
    ReplacedTile() : tiles_(open_set(write(plane(10.0)))) {}

    static constexpr double west = 300000.0;
    static constexpr double north = 5600000.0;
    static double height_at(double x, double y) {
        return 100.0 + 0.03 * (x - west) + 0.02 * (north - y);
    }
    static test::MadeRaster plane(double step) {
        const int side = static_cast<int>(std::lround(1000.0 / step));
        return placed(test::made_raster(side, side,
                                        [&](int col, int row) {
                                            return height_at(west + (col + 0.5) * step,
                                                             north - (row + 0.5) * step);
                                        }),
                      step);
    }
    std::filesystem::path write(const test::MadeRaster& raster) {
        const auto file = folder_.path() / "a.tif";
        std::filesystem::remove(file);
        EXPECT_TRUE(test::write(raster, file));
        std::filesystem::last_write_time(file, std::filesystem::last_write_time(file) +
                                                   std::chrono::seconds(++written_));
        return file;
    }
    [[nodiscard]] TileWindow read() const {
        return read_tree_tile(tiles_, {tiles_.grid()}, TileTree(100, 100), {0, 0, 0}, Gaps::holes);
    }
    /// Without those along the border, where samples are missing beyond it.
    void expect_plane(double most) const {
        const TileWindow window = read();
        ASSERT_TRUE(window.errors.empty()) << window.errors.front().message;
        EXPECT_FALSE(std::ranges::any_of(window.heights.samples(),
                                         [](double height) { return std::isnan(height); }));
        for (int row = 6; row < terrain::tree_tile_cells; ++row) {
            for (int col = 6; col < terrain::tree_tile_cells; ++col) {
                const double x = west + (col - 1 + 0.5) * 10.0;
                const double y = north - (row - 1 + 0.5) * 10.0;
                ASSERT_NEAR(window.heights(col, row), height_at(x, y), most) << col << " " << row;
            }
        }
    }
    void expect_fault(const std::string& words) const {
        const auto window = read();
        ASSERT_EQ(window.errors.size(), 1U);
        EXPECT_THAT(window.errors.front().message,
                    ::testing::AllOf(::testing::HasSubstr("a.tif: was replaced while it was open"),
                                     ::testing::HasSubstr(words)));
    }

    test::TemporaryFolder folder_;
    int written_ = 0;
    TileSet tiles_;
};

constexpr double rounding = 1e-4; // of heights as float

TEST_F(ReplacedTile, ByOneOfAnotherSpacingIsReadAtTheSamplesItHadAndTold) {
    expect_plane(rounding);
    EXPECT_THAT(tiles_.take_new_notes(), ::testing::IsEmpty());
    write(plane(25.0));
    expect_plane(rounding);
    expect_plane(rounding);
    EXPECT_THAT(tiles_.take_new_notes(),
                ::testing::ElementsAre(::testing::EndsWith(
                    "a.tif: was replaced while it was open, by 40×40 samples: they are read at the "
                    "places of the 100×100 before until the next start")));
    write(plane(2.0));
    expect_plane(rounding);
    EXPECT_THAT(tiles_.take_new_notes(), ::testing::ElementsAre(::testing::HasSubstr("500×500")));
    write(plane(10.0));
    EXPECT_EQ(read().heights(51, 51), static_cast<float>(height_at(west + 505.0, north - 505.0)));
    EXPECT_THAT(tiles_.take_new_notes(),
                ::testing::ElementsAre(::testing::HasSubstr("a.tif: changed while open")));
}

TEST_F(ReplacedTile, ByOneOfAnotherSystemUnitAndTypeIsReadAsHeightsInMetres) {
    const auto transform = CrsTransform::create("EPSG:4326", "EPSG:32631");
    auto raster = test::made_raster(400, 400, [&](int col, int row) {
        std::array point{glm::dvec2(0.17 + (col + 0.5) * 1e-4, 50.52 - (row + 0.5) * 1e-4)};
        transform->apply(point);
        return std::lround(height_at(point[0].x, point[0].y) / 0.3048 * 100.0);
    });
    raster.type = GDT_Int32;
    raster.crs = "EPSG:4326";
    raster.geotransform = {0.17, 1e-4, 0.0, 50.52, 0.0, -1e-4};
    raster.unit = "ft";
    raster.scale = 0.01;
    write(raster);
    expect_plane(0.01);
}

TEST_F(ReplacedTile, KeepsVoidsApartFromHeights) {
    auto raster = plane(20.0);
    raster.type = GDT_Int16;
    raster.values[25 * 50 + 25] = -32768; // declared or not
    for (const auto& nodata : {std::optional<double>(-32768.0), std::optional<double>()}) {
        raster.nodata = nodata;
        write(raster);
        const auto window = read();
        ASSERT_TRUE(window.errors.empty()) << window.errors.front().message;
        int voids = 0;
        for (const double height : window.heights.samples()) {
            voids += std::isnan(height) ? 1 : 0;
            EXPECT_FALSE(height < 99.0) << height;
        }
        EXPECT_GT(voids, 0);
        EXPECT_LE(voids, 16);
    }
}

TEST_F(ReplacedTile, ByOneOfOtherGroundIsAFaultUntilTheFirstIsBack) {
    auto moved = plane(10.0);
    moved.geotransform->at(0) += 500.0; // of the same size
    write(moved);
    expect_fault(
        "by 100×100 samples that are no heights over all the ground of the 100×100 before");
    auto nowhere = plane(20.0);
    nowhere.crs = "";
    nowhere.geotransform = std::nullopt;
    write(nowhere);
    expect_fault("by 50×50 samples");
    write(plane(10.0));
    expect_plane(rounding);
}

TEST(TreeTiles, AFileThatIsGoneIsAFaultAndBackAgainWhenItIs) {
    const test::TemporaryFolder folder;
    const auto file = folder.path() / "a.tif";
    ASSERT_TRUE(test::write(
        placed(test::made_raster(100, 100, [](int col, int) { return col; }), 10.0), file));
    const TileSet tiles = open_set(file);
    const auto read = [&] {
        return read_tree_tile(tiles, {tiles.grid()}, TileTree(100, 100), {0, 0, 0}, Gaps::holes);
    };
    ASSERT_TRUE(read().errors.empty());
    std::filesystem::rename(file, folder.path() / "b.tif");
    const auto gone = read();
    ASSERT_EQ(gone.errors.size(), 1U);
    EXPECT_THAT(gone.errors.front().message, ::testing::HasSubstr("a.tif: does not exist"));
    std::filesystem::rename(folder.path() / "b.tif", file);
    EXPECT_TRUE(read().errors.empty());
}

} // namespace
} // namespace reljef::io
