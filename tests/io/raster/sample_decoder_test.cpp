// Values that many programs write for voids, in files that do not declare them.
#include "engine/io/raster/sample_decoder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/terrain_file.h"
#include "engine/io/tile_set.h"
#include "tests/io/made_raster.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using test::joined;
using test::MadeRaster;
using ::testing::HasSubstr;

class UsualVoids : public ::testing::Test {
protected:
    /// In a coordinate system.
    template <class Value> static MadeRaster placed(int side, const Value& value) {
        MadeRaster raster = test::made_raster(side, side, value);
        raster.crs = "EPSG:32631";
        raster.geotransform = {300000.0, 10.0, 0.0, 5600000.0, 0.0, -10.0};
        return raster;
    }
    [[nodiscard]] std::filesystem::path made(const MadeRaster& raster) const {
        EXPECT_TRUE(test::write(raster, folder_.path() / "made.tif"));
        return folder_.path() / "made.tif";
    }
    [[nodiscard]] terrain::Terrain read(const MadeRaster& raster) const {
        auto terrain = read_terrain(made(raster), {});
        EXPECT_TRUE(terrain) << (terrain ? "" : terrain.error().message);
        return terrain ? std::move(*terrain) : terrain::Terrain{};
    }
    static double slope(int col, int row) { return 300.0 + col + 2 * row; }

    test::TemporaryFolder folder_;
};

TEST_F(UsualVoids, FarFromAllHeightsAreVoids) {
    for (const double value : {-9999.0, -32768.0, -32767.0, -99999.0, -999999.0, 65535.0}) {
        MadeRaster raster = placed(20, slope);
        raster.type = value < 0.0 ? GDT_Int32 : GDT_UInt16;
        raster.values[3] = value;
        raster.values[77] = value;
        const terrain::Terrain terrain = read(raster);
        EXPECT_EQ(terrain.heightfield.void_count, 2U) << value;
        EXPECT_THAT(joined(terrain.notes),
                    HasSubstr(fmt::format("2 samples are {}, which {} does not declare", value,
                                          (folder_.path() / "made.tif").string())));
        raster.values[78] = 0.95 * value; // ground beside it
        const terrain::Terrain near = read(raster);
        if (value == -32768.0 || value == -32767.0) { // below all ground
            EXPECT_EQ(near.heightfield.void_count, 2U) << value;
            continue;
        }
        EXPECT_EQ(near.heightfield.void_count, 0U) << value;
        EXPECT_THAT(joined(near.notes), HasSubstr("taken for heights")) << value;
    }
}

// A picture without a coordinate system is often stretched to all numbers of its type.
TEST_F(UsualVoids, TheWhiteOfAPictureIsAHeight) {
    MadeRaster raster = test::made_raster(20, 20, slope);
    raster.type = GDT_UInt16;
    raster.values[3] = 65535.0;
    EXPECT_EQ(read(raster).heightfield.void_count, 0U);
}

// Ground near the value may lie in another part of the file than the value.
TEST_F(UsualVoids, AreVoidsInAllPartsOfAFileOrInNone) {
    constexpr int side = 700; // more samples than one read of a tile
    for (const auto& [bottom, voids] : {std::pair{40.0, 81}, std::pair{-9990.0, 0}}) {
        const double lowest = bottom;
        const MadeRaster raster = placed(side, [lowest](int col, int row) {
            return col < 9 && row < 9 ? -9999.0 : row == side - 1 && col > 600 ? lowest : 50.0;
        });
        EXPECT_EQ(read(raster).heightfield.void_count, static_cast<std::size_t>(voids));
        const auto tiles = TileSet::open(made(raster));
        ASSERT_TRUE(tiles) << tiles.error().message;
        TileGrid corner = tiles->grid();
        corner.cols = corner.rows = 20;
        const TileWindow window = tiles->read(corner, Gaps::holes);
        EXPECT_EQ(std::count_if(window.heights.samples().begin(), window.heights.samples().end(),
                                [](double height) { return std::isnan(height); }),
                  voids)
            << bottom;
    }
}

// Parts of a file that hold heights alone are decoded in another way than those with a void.
TEST_F(UsualVoids, ChangeNoHeightAroundThem) {
    MadeRaster raster = placed(20, slope);
    raster.type = GDT_Float32;
    raster.nodata = -500.0;
    const terrain::Terrain whole = read(raster);
    ASSERT_EQ(whole.heightfield.void_count, 0U);
    constexpr double infinite = std::numeric_limits<double>::infinity();
    for (const double value : {-500.0, -9999.0, -32768.0, std::nan(""), -infinite, 1e9}) {
        MadeRaster holed = raster;
        holed.values[207] = value;
        const terrain::Terrain terrain = read(holed);
        EXPECT_EQ(terrain.heightfield.void_count, 1U) << value;
        for (std::size_t i = 0; i < holed.values.size(); ++i) {
            if (i != 207) {
                ASSERT_EQ(terrain.heightfield.heights.samples()[i],
                          whole.heightfield.heights.samples()[i])
                    << value;
            }
        }
    }
}

// No more of a large file is searched than blocks that are spread over it.
TEST_F(UsualVoids, OfAFileOfBlocksAreJudgedByAllOfIt) {
    constexpr int side = 2000; // strips of a few rows, of which 64 are searched
    for (const bool has_trench : {false, true}) {
        const MadeRaster raster = placed(side, [has_trench](int /*col*/, int row) {
            return row < 8 ? -9999.0 : has_trench && row > side - 40 ? -9990.0 : 50.0;
        });
        const auto tiles = TileSet::open(made(raster));
        ASSERT_TRUE(tiles) << tiles.error().message;
        TileGrid corner = tiles->grid();
        corner.cols = corner.rows = 4;
        EXPECT_EQ(std::isnan(tiles->read(corner, Gaps::holes).heights(1, 1)), !has_trench);
    }
}

} // namespace
} // namespace reljef::io
