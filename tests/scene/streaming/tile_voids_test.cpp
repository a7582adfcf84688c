#include "engine/scene/streaming/tile_voids.h"

#include <cmath>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

namespace reljef::scene {
namespace {

constexpr int tile_side = 67; // 64 cells, and one step around
constexpr float no_height = std::numeric_limits<float>::quiet_NaN();

float height_on_slope(int col, int row) {
    return 900.0F + 12.0F * static_cast<float>(col) - 7.0F * static_cast<float>(row);
}

// From a sample of the raster on; the overview is 150 m too low.
Grid<float> slope_from(int first_col, float below = 0.0F) {
    Grid<float> heights(tile_side, tile_side);
    for (int row = 0; row < tile_side; ++row) {
        for (int col = 0; col < tile_side; ++col) {
            heights(col, row) = height_on_slope(first_col + col, row) - below;
        }
    }
    return heights;
}

void open_void(Grid<float>& heights, int first_col, int from, int to) {
    for (int row = 20; row < 50; ++row) {
        for (int col = 0; col < tile_side; ++col) {
            if (first_col + col >= from && first_col + col < to) {
                heights(col, row) = no_height;
            }
        }
    }
}

// The overview is an average: voids that took its heights had cliffs around them.
TEST(TileVoids, HaveNoStepsAtTheHeightsAroundThem) {
    Grid<float> heights = slope_from(0);
    open_void(heights, 0, 15, 45);
    const FilledHeights filled = fill_tile_voids(std::move(heights), slope_from(0, 150.0F));
    for (int row = 0; row < tile_side; ++row) {
        for (int col = 0; col < tile_side; ++col) {
            ASSERT_NEAR(filled.heights(col, row), height_on_slope(col, row), 1.0)
                << col << ' ' << row;
        }
    }
    EXPECT_EQ(filled.was_void(15, 20), 1);
    EXPECT_EQ(filled.was_void(14, 20), 0);
}

TEST(TileVoids, NeighboursAgreeOnTheBorderBetweenThem) {
    Grid<float> west = slope_from(0);
    Grid<float> east = slope_from(64);
    open_void(west, 0, 40, 90);
    open_void(east, 64, 40, 90);
    const Grid<float> of_west = fill_tile_voids(west, slope_from(0, 150.0F)).heights;
    const Grid<float> of_east = fill_tile_voids(east, slope_from(64, 150.0F)).heights;
    for (int row = 1; row + 1 < tile_side; ++row) {
        ASSERT_EQ(of_west(65, row), of_east(1, row)) << row;
    }
}

TEST(TileVoids, StayBetweenKnownAndCoarseHeights) {
    Grid<float> heights(tile_side, tile_side, 500.0F);
    open_void(heights, 0, 10, 60);
    heights(5, 30) = 900.0F;
    Grid<float> coarse(tile_side, tile_side, 400.0F);
    coarse(30, 30) = 880.0F;
    const FilledHeights filled = fill_tile_voids(std::move(heights), coarse);
    for (const float height : filled.heights.samples()) {
        ASSERT_GE(height, 400.0F);
        ASSERT_LE(height, 900.0F);
    }
}

TEST(TileVoids, ATileWithoutAnyHeightIsTheOverview) {
    const Grid<float> coarse = slope_from(0);
    EXPECT_EQ(fill_tile_voids(Grid<float>(tile_side, tile_side, no_height), coarse).heights,
              coarse);
}

} // namespace
} // namespace reljef::scene
