#include "engine/io/formats/raster_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/raster/raster.h"
#include "engine/io/terrain_file.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

float height_at(int col, int row) {
    return static_cast<float>(3 * col - 2 * row) + 0.25F;
}

void fill(int first_row, GridView<float> heights) {
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            heights(col, row) = height_at(col, first_row + row);
        }
    }
}

TEST(RasterWriter, WhatIsWrittenIsReadBitByBit) {
    const test::TemporaryFolder folder;
    const auto path = folder.path() / "ground.tif";
    const HeightRaster raster{300, 1100, 20.0, {400'000.0, 5'100'000.0}};
    std::vector<double> told;
    const auto written = write_heights(path, raster, fill,
                                       {0, {}, [&](double fraction) { told.push_back(fraction); }});
    ASSERT_TRUE(written) << written.error().message;
    EXPECT_EQ(told.back(), 1.0);
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    const auto terrain = read_terrain(path);
    ASSERT_TRUE(terrain) << terrain.error().message;
    ASSERT_EQ(terrain->heightfield.heights.rows(), 1100);
    for (int row = 0; row < 1100; row += 7) {
        for (int col = 0; col < 300; ++col) {
            ASSERT_EQ(terrain->heightfield.heights(col, row), height_at(col, row));
        }
    }
    EXPECT_THAT(read_raster_info(path)->crs_name, testing::HasSubstr("UTM zone 32N"));
    EXPECT_THAT(folder.names(), testing::ElementsAre("ground.tif"));
}

TEST(RasterWriter, StoppedItLeavesNothing) {
    const test::TemporaryFolder folder;
    std::stop_source stop;
    const auto written =
        write_heights(folder.path() / "ground.tif", {600, 600, 1.0, {}}, fill,
                      {0, stop.get_token(), [&](double /*fraction*/) { stop.request_stop(); }});
    ASSERT_FALSE(written);
    EXPECT_THAT(written.error().message, testing::HasSubstr("stopped"));
    EXPECT_TRUE(folder.names().empty());
}

TEST(RasterWriter, AFolderThatIsNotThereIsTold) {
    const auto written = write_heights("/nowhere/at/all.tif", {4, 4, 1.0, {}}, fill);
    ASSERT_FALSE(written);
    EXPECT_THAT(written.error().message, testing::HasSubstr("/nowhere/at/all.tif"));
}

} // namespace
} // namespace reljef::io
