#include <filesystem>
#include <random>

#include <gdal_priv.h>
#include <gtest/gtest.h>

#include "engine/io/raster/raster.h"
#include "engine/io/terrain_file.h"
#include "tests/io/made_raster.h"
#include "tests/support/bytes_read.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

// A row of blocks exceeds the cache, so reads as wide as the raster would decode each block anew
// for each of their rows.
TEST(SampleReader, DecodesNoBlockAnewForEachRow) {
    constexpr int side = 2048;
    std::mt19937 random(3);
    test::MadeRaster raster =
        test::made_raster(side, side, [&](int, int) { return random() % 1000; });
    raster.type = GDT_Int16;
    raster.options = {"TILED=YES", "COMPRESS=DEFLATE"};
    const test::TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "blocks.tif";
    ASSERT_TRUE(test::write(raster, path));
    RasterOptions options;
    options.memory_budget = 128 * 128 * bytes_per_sample;
    const GIntBig cache = GDALGetCacheMax64();
    limit_block_cache(std::size_t{4 * 256 * 256 * 2}); // of 8 blocks side by side
    const std::size_t before = test::bytes_read();
    const auto terrain = read_terrain(path, options);
    const std::size_t read = test::bytes_read() - before;
    GDALSetCacheMax64(cache);
    ASSERT_TRUE(terrain) << terrain.error().message;
    EXPECT_EQ(terrain->heightfield.heights.cols(), 128);
    EXPECT_LE(read, 3 * std::filesystem::file_size(path));
}

} // namespace
} // namespace reljef::io
