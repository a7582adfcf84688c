#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/tile_set.h"
#include "tests/io/made_raster.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

void damage_block(const std::filesystem::path& path, const char* name) {
    std::streamoff place = 0;
    {
        const auto dataset = open_raster(path, GdalMessages());
        ASSERT_TRUE(dataset);
        place = std::stoll((*dataset)->GetRasterBand(1)->GetMetadataItem(name, "TIFF"));
    }
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(place);
    file << std::string(64, '\xff');
}

// One spoiled place made everything that was read together a void: at coarse levels, the terrain.
class TileTerrain : public testing::TestWithParam<std::pair<int, const char*>> {};

// The second block reaches into all quarters of the terrain.
INSTANTIATE_TEST_SUITE_P(Blocks, TileTerrain,
                         testing::Values(std::pair(1024, "BLOCK_OFFSET_1_2"),
                                         std::pair(1000, "BLOCK_OFFSET_1_1")),
                         [](const auto& info) { return "Of" + std::to_string(info.param.first); });

TEST_P(TileTerrain, AnUnreadablePlaceLosesOnlyWhatIsAroundIt) {
    const auto [side, block] = GetParam();
    const test::TemporaryFolder folder;
    auto raster = test::made_raster(side, side, [](int col, int row) { return col + 2.0 * row; });
    raster.crs = "EPSG:32631";
    raster.geotransform = {300000.0, 10.0, 0.0, 5600000.0, 0.0, -10.0};
    raster.type = GDT_Int16;
    raster.options = {"TILED=YES", "COMPRESS=DEFLATE"}; // blocks of 256
    const auto path = folder.path() / "dem.tif";
    ASSERT_TRUE(test::write(raster, path));
    damage_block(path, block);
    auto tiles = TileSet::open(path);
    ASSERT_TRUE(tiles);
    for (const int reduction : {1, 4}) {
        TileTerrainOptions options;
        const auto samples = static_cast<std::size_t>(side / reduction);
        options.raster.memory_budget = samples * samples * bytes_per_sample;
        const auto terrain = tiles->terrain(options);
        ASSERT_TRUE(terrain) << terrain.error().message;
        EXPECT_EQ(terrain->errors.size(), 1U) << reduction;
        const terrain::Heightfield& field = terrain->heightfield;
        EXPECT_EQ(field.reduction, reduction);
        ASSERT_EQ(field.heights.cols(), side / reduction);
        const double share =
            static_cast<double>(field.void_count) / static_cast<double>(field.heights.size());
        EXPECT_GE(share, 0.06);
        EXPECT_LE(share, 0.15) << reduction;
        for (const glm::ivec2 at : {glm::ivec2(0), {side - 1, 0}, {0, side - 1}, {700, 500}}) {
            const glm::ivec2 sample = at / reduction;
            ASSERT_EQ(field.void_mask(sample.x, sample.y), 0);
            const double half = 0.5 * (reduction - 1);
            EXPECT_NEAR(field.heights(sample.x, sample.y),
                        sample.x * reduction + half + 2.0 * (sample.y * reduction + half), 1e-3);
        }
    }
}

} // namespace
} // namespace reljef::io
