// Overviews that average voids, of which the file says nothing, with heights.
#include "engine/io/raster/mixed_overviews.h"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/raster/raster.h"
#include "engine/io/terrain_file.h"
#include "engine/io/tree_tile.h"
#include "tests/io/made_raster.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using test::joined;
using test::made_raster;
using test::MadeRaster;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr int holed_side = 600;

double rolling_hills(int col, int row) {
    return std::round(500.0 + 200.0 * std::sin(0.02 * col) * std::cos(0.03 * row));
}

/// A border, a lake and single samples.
bool is_in_hole(int col, int row) {
    const int x = col - 400;
    const int y = row - 250;
    return col < 40 || x * x + y * y < 50 * 50 || (col * 7919 + row * 104729) % 4001 == 0;
}

MadeRaster raster_with_holes(double value, GDALDataType type = GDT_Int16) {
    MadeRaster raster = made_raster(holed_side, holed_side, [&](int col, int row) {
        return is_in_hole(col, row) ? value : rolling_hills(col, row);
    });
    raster.type = type;
    raster.crs = "EPSG:32631";
    raster.geotransform = {300000.0, 10.0, 0.0, 5600000.0, 0.0, -10.0};
    return raster;
}

class MixedOverviews : public testing::Test {
protected:
    [[nodiscard]] std::filesystem::path made(MadeRaster raster, const std::string& name,
                                             std::vector<int> overviews) const {
        raster.overviews = std::move(overviews);
        EXPECT_TRUE(test::write(raster, folder_.path() / name));
        return folder_.path() / name;
    }
    [[nodiscard]] bool mixes(const MadeRaster& raster, std::vector<int> overviews) const {
        const GdalMessages messages;
        const std::filesystem::path path = made(raster, "mixes.tif", std::move(overviews));
        const auto dataset = open_raster(path, messages);
        EXPECT_TRUE(dataset);
        return *overviews_mix_voids(**dataset, path);
    }

    test::TemporaryFolder folder_;
};

TEST_F(MixedOverviews, AreFoundWhateverTheVoidAndTheType) {
    for (const std::vector<int>& overviews : {std::vector{2}, {2, 4, 8}, {8}}) {
        EXPECT_TRUE(mixes(raster_with_holes(-32768.0), overviews));
        EXPECT_TRUE(mixes(raster_with_holes(-32767.0), overviews));
        EXPECT_TRUE(mixes(raster_with_holes(-32768.0, GDT_Float32), overviews));
    }
    EXPECT_FALSE(mixes(raster_with_holes(-32768.0), {}));
}

TEST_F(MixedOverviews, OfASingleVoidAreFoundToo) {
    MadeRaster raster = made_raster(holed_side, holed_side, rolling_hills);
    raster.type = GDT_Int16;
    EXPECT_FALSE(mixes(raster, {2, 4, 8, 16}));
    raster.values[std::size_t{300} * holed_side + 123] = -32768.0;
    for (const int overview : {2, 4, 8, 16}) {
        EXPECT_TRUE(mixes(raster, {overview})) << overview;
    }
}

TEST_F(MixedOverviews, AreNotThoseOfDeclaredVoidsSeasAndCliffs) {
    MadeRaster declared = raster_with_holes(-32768.0);
    declared.nodata = -32768.0;
    EXPECT_FALSE(mixes(declared, {2, 4, 8}));
    MadeRaster sea = made_raster(holed_side, holed_side, [](int col, int row) {
        return (col / 37 + row / 41) % 2 == 0 ? 4000.0 : -10900.0 + col;
    });
    sea.type = GDT_Float32;
    EXPECT_FALSE(mixes(sea, {2, 4, 8}));
    MadeRaster positive = raster_with_holes(0.0);
    positive.type = GDT_UInt16;
    EXPECT_FALSE(mixes(positive, {2, 4, 8}));
}

TEST_F(MixedOverviews, AreReadNowhereByATerrainThatIsReadCoarser) {
    for (const int reduction : {1, 2, 3, 4, 5, 8, 15}) {
        RasterOptions options;
        const int coarse = holed_side / reduction;
        options.memory_budget = bytes_per_sample * static_cast<std::size_t>(coarse * coarse);
        const auto with =
            read_terrain(made(raster_with_holes(-32768.0), "a.tif", {2, 4, 8}), options);
        const auto without = read_terrain(made(raster_with_holes(-32768.0), "b.tif", {}), options);
        ASSERT_TRUE(with && without);
        EXPECT_EQ(with->heightfield.heights, without->heightfield.heights) << reduction;
        EXPECT_EQ(with->heightfield.void_mask, without->heightfield.void_mask) << reduction;
        EXPECT_GE(with->heightfield.range.low, 300.0) << reduction;
        EXPECT_THAT(joined(with->notes), HasSubstr("they are not used")) << reduction;
        EXPECT_THAT(joined(without->notes), Not(HasSubstr("overviews"))) << reduction;
    }
}

TEST_F(MixedOverviews, MakeNoPitsInTilesOfAnyLevel) {
    const auto with = TileSet::open(made(raster_with_holes(-32768.0), "a.tif", {2, 4, 8}));
    const auto without = TileSet::open(made(raster_with_holes(-32768.0), "b.tif", {}));
    ASSERT_TRUE(with && without);
    const terrain::TileTree tree(holed_side, holed_side);
    for (int level = 0; level <= tree.root().level; ++level) {
        const terrain::TreeTile tile{level, 0, 0};
        const auto a = read_tree_tile(*with, {with->grid()}, tree, tile, Gaps::holes).heights;
        const auto b = read_tree_tile(*without, {without->grid()}, tree, tile, Gaps::holes).heights;
        std::size_t heights = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            const double height = a.samples()[i];
            ASSERT_TRUE(std::isnan(height) || (height >= 300.0 && height <= 700.0)) << height;
            ASSERT_EQ(std::isnan(height), std::isnan(b.samples()[i]));
            ASSERT_TRUE(std::isnan(height) || height == b.samples()[i]);
            heights += std::isnan(height) ? 0U : 1U;
        }
        EXPECT_GT(heights, 0U) << level;
    }
    EXPECT_THAT(joined(with->take_new_notes()), HasSubstr("a.tif: its overviews are averages of"));
}

TEST_F(MixedOverviews, ThatAreGoodAreStillRead) {
    MadeRaster declared = raster_with_holes(-32768.0);
    declared.nodata = -32768.0;
    RasterOptions options;
    options.memory_budget = bytes_per_sample * 150 * 150;
    const auto coarse = read_terrain(made(declared, "a.tif", {4}), options);
    ASSERT_TRUE(coarse);
    EXPECT_THAT(joined(coarse->notes), Not(HasSubstr("not used")));
    EXPECT_EQ(coarse->heightfield.heights(100, 100),
              std::round(coarse->heightfield.heights(100, 100)))
        << "averages of the file are whole numbers";
}

TEST_F(MixedOverviews, AFolderTellsOfVoidsThatItsFilesDoNotDeclare) {
    const std::filesystem::path folder = folder_.path() / "tiles";
    std::filesystem::create_directory(folder);
    for (const char* name : {"a.tif", "b.tif"}) {
        ASSERT_TRUE(test::write(raster_with_holes(-32767.0), folder / name));
    }
    MadeRaster doubtful = raster_with_holes(-9999.0);
    doubtful.geotransform = {306000.0, 10.0, 0.0, 5600000.0, 0.0, -10.0};
    ASSERT_TRUE(test::write(doubtful, folder / "c.tif"));
    MadeRaster declared = raster_with_holes(-32768.0);
    declared.nodata = -32768.0;
    declared.geotransform = {312000.0, 10.0, 0.0, 5600000.0, 0.0, -10.0};
    ASSERT_TRUE(test::write(declared, folder / "d.tif"));
    const auto tiles = TileSet::open(folder);
    ASSERT_TRUE(tiles);
    const auto terrain = tiles->terrain({});
    ASSERT_TRUE(terrain);
    const std::string notes = joined(terrain->notes);
    EXPECT_THAT(notes, HasSubstr("a.tif and 1 more: undeclared -32767, taken for voids"));
    EXPECT_THAT(notes, HasSubstr("c.tif: undeclared -9999, taken for voids"));
    EXPECT_THAT(notes, Not(HasSubstr("d.tif")));
    EXPECT_TRUE(tiles->take_new_notes().empty()) << "each is told once";
}

TEST_F(MixedOverviews, OfTwoToThe31ColumnsOverflowNothing) {
    MadeRaster small = raster_with_holes(-32768.0);
    small.geotransform.reset();
    ASSERT_TRUE(test::write(small, folder_.path() / "small.tif"));
    const auto path = folder_.write(
        "wide.vrt",
        "<VRTDataset rasterXSize=\"2147483647\" rasterYSize=\"2147483647\"><VRTRasterBand "
        "dataType=\"Int16\" band=\"1\"><Overview><SourceFilename relativeToVRT=\"1\">small.tif"
        "</SourceFilename><SourceBand>1</SourceBand></Overview></VRTRasterBand></VRTDataset>");
    const GdalMessages messages;
    const auto dataset = open_raster(path, messages);
    ASSERT_TRUE(dataset) << dataset.error().message;
    EXPECT_EQ(overviews_mix_voids(**dataset, path), false); // all its samples are 0
}

} // namespace
} // namespace reljef::io
