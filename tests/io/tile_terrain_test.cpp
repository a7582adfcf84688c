#include <cmath>
#include <fstream>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/terrain_file.h"
#include "engine/io/tile_set.h"
#include "engine/terrain/field/placement.h"
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

// Places in the scene depended on the memory: a reduction leaves out the last samples, and the
// middle of the others was taken for that of the terrain.
class SceneOfReduction : public testing::TestWithParam<std::tuple<int, std::string, bool>> {
protected:
    // Where a reading puts a place of the source, metres.
    static glm::dvec3 world_of(const terrain::Heightfield& field, glm::dvec2 sample) {
        const auto placement = terrain::Placement::create(field, terrain::PlacementKind::plane);
        const double k = field.reduction;
        return placement->world_from_sample({(sample - 0.5 * (k - 1.0)) / k, 0.0});
    }
};

INSTANTIATE_TEST_SUITE_P(Rasters, SceneOfReduction,
                         testing::Combine(testing::Values(2, 3, 7),
                                          testing::Values("EPSG:32631", "EPSG:4326", ""),
                                          testing::Bool()));

TEST_P(SceneOfReduction, IsThatOfAllSamples) {
    const auto& [reduction, crs, runs_north] = GetParam();
    constexpr glm::ivec2 size(97, 83);
    const test::TemporaryFolder folder;
    auto raster = test::made_raster(size.x, size.y, [](int col, int row) { return col + row; });
    raster.crs = crs;
    const double step = crs == "EPSG:4326" ? 0.01 : 10.0;
    raster.geotransform = {crs == "EPSG:4326" ? 6.0 : 300000.0,   step, 0.0,
                           crs == "EPSG:4326" ? 45.0 : 5600000.0, 0.0,  runs_north ? step : -step};
    const auto path = folder.path() / "dem.tif";
    ASSERT_TRUE(test::write(raster, path));
    TileTerrainOptions options;
    options.raster.memory_budget = static_cast<std::size_t>(size.x / reduction) *
                                   static_cast<std::size_t>(size.y / reduction) * bytes_per_sample;
    TileSetOptions planes;
    planes.allows_planes = true;
    const auto tiles = TileSet::open(path, planes);
    ASSERT_TRUE(tiles) << tiles.error().message;
    const auto whole = tiles->terrain({});
    const auto of_tiles = tiles->terrain(options);
    const auto of_file = read_terrain(path, options.raster);
    ASSERT_TRUE(whole && of_tiles && of_file);
    for (const auto* const reduced : {&*of_tiles, &*of_file}) {
        ASSERT_EQ(reduced->heightfield.reduction, reduction);
        // The last rows of a file are left out: the first ones if it runs north.
        const bool leaves_first = runs_north && reduced == &*of_file;
        const double left_out = leaves_first ? size.y % reduction : 0;
        for (const glm::dvec2 place : {glm::dvec2(0.0), {48.0, 41.0}, {96.0, 10.0}}) {
            const glm::dvec3 all = world_of(whole->heightfield, place);
            const glm::dvec3 fewer =
                world_of(reduced->heightfield, place - glm::dvec2(0.0, left_out));
            EXPECT_NEAR(all.x, fewer.x, 1e-6);
            EXPECT_NEAR(all.y, fewer.y, 1e-6);
        }
    }
}

} // namespace
} // namespace reljef::io
