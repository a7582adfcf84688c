#include "engine/terrain/mesh/tile_layout.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <gtest/gtest.h>

#include "engine/terrain/field/min_max_pyramid.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::terrain {
namespace {

TEST(TileLayout, CoversEveryCellOnceWhateverTheSize) {
    for (const auto& [cols, rows] : {std::pair{2, 2},
                                     {3, 1000},
                                     {1000, 3},
                                     {129, 129},
                                     {130, 129},
                                     {129, 130},
                                     {128, 128},
                                     {257, 258},
                                     {2, 500},
                                     {400, 301}}) {
        Grid<int> covered(cols - 1, rows - 1, 0);
        for (const TileCells& tile : tile_layout({cols - 1, rows - 1})) {
            ASSERT_GE(std::min(tile.count.x, tile.count.y), 1);
            ASSERT_LE(std::max(tile.count.x, tile.count.y), tile_cells);
            for (int row = tile.first.y; row < tile.last().y; ++row) {
                for (int col = tile.first.x; col < tile.last().x; ++col) {
                    ++covered(col, row);
                }
            }
        }
        for (const int count : covered.samples()) {
            ASSERT_EQ(count, 1) << cols << " x " << rows;
        }
    }
}

Box box_of(const Heightfield& heightfield, const Placement& placement, const TileCells& tile,
           std::optional<double> flat_height) {
    const MinMax range =
        MinMaxPyramid(heightfield.heights.view()).bounds(tile.first, tile.last() - 1);
    return placed_bounds(placement, glm::dvec2(tile.first), glm::dvec2(tile.last()),
                         {flat_height.value_or(range.low), flat_height.value_or(range.high)});
}

// The tile's box holds its samples, and the middles between them.
void expect_inside(const Heightfield& heightfield, const Placement& placement,
                   const TileCells& tile, std::optional<double> flat_height) {
    const Box bounds = box_of(heightfield, placement, tile, flat_height);
    for (int j = 0; j <= 2 * tile.count.y; ++j) {
        for (int i = 0; i <= 2 * tile.count.x; ++i) {
            const double col = tile.first.x + 0.5 * i;
            const double row = tile.first.y + 0.5 * j;
            const double height =
                flat_height.value_or(bilinear_height(heightfield.heights.view(), {col, row}));
            const glm::dvec3 place = placement.world_from_sample({col, row, height});
            for (int axis = 0; axis < 3; ++axis) {
                ASSERT_GE(place[axis], bounds.low[axis] - 1e-9) << col << ' ' << row << ' ' << axis;
                ASSERT_LE(place[axis], bounds.high[axis] + 1e-9)
                    << col << ' ' << row << ' ' << axis;
            }
        }
    }
}

void expect_bounds_hold(const Heightfield& heightfield, double exaggeration) {
    const Placement placement = test::placed(heightfield, exaggeration);
    for (const TileCells& tile : tile_layout(test::cells_of(heightfield))) {
        expect_inside(heightfield, placement, tile, std::nullopt);
        expect_inside(heightfield, placement, tile, reference_height(heightfield));
    }
}

TEST(TileLayout, BoundsOnAPlaneAreTight) {
    const Heightfield heightfield =
        test::plane_heightfield(test::random_heights(150, 140, -7.0F, 9.0F, 2), {2.0, 3.0});
    const Placement placement = test::placed(heightfield, 4.0);
    expect_bounds_hold(heightfield, 4.0);
    Box all;
    for (const TileCells& tile : tile_layout(test::cells_of(heightfield))) {
        all.add(box_of(heightfield, placement, tile, std::nullopt));
    }
    EXPECT_DOUBLE_EQ(all.low.z, 4.0 * heightfield.range.low);
    EXPECT_DOUBLE_EQ(all.high.z, 4.0 * heightfield.range.high);
    EXPECT_DOUBLE_EQ(all.size().x, 149 * 2.0);
    EXPECT_DOUBLE_EQ(all.size().y, 139 * 3.0);
}

// Neighbours share the samples on their border: both must hold them.
TEST(TileLayout, BoundsHoldASpikeOnTheBorderOfTiles) {
    for (const glm::ivec2 spike :
         {glm::ivec2(128, 50), glm::ivec2(50, 128), glm::ivec2(128, 128), glm::ivec2(0, 0),
          glm::ivec2(199, 30), glm::ivec2(30, 179), glm::ivec2(199, 179)}) {
        for (const float height : {100.0F, -100.0F}) {
            Grid<float> heights(200, 180, 0.0F);
            heights(spike.x, spike.y) = height;
            expect_bounds_hold(test::plane_heightfield(heights), 1.0);
        }
    }
}

TEST(TileLayout, BoundsOnAnEllipsoidHoldEverySample) {
    for (const double latitude : {0.6, 46.0, -33.0, 84.0}) {
        expect_bounds_hold(
            test::geographic_heightfield(test::random_heights(150, 140, 0.0F, 900.0F, 3), latitude,
                                         7.0, 1.0 / 1200.0),
            1.0);
    }
}

// The top of the Earth's bulge, at the frame's origin, lies neither on a tile's border nor in its
// middle when 193 samples are cut at 128.
TEST(TileLayout, BoundsHoldTheTopOfTheBulgeWhereverItLies) {
    for (const int side : {193, 161, 209, 130}) {
        for (const double step : {1.0 / 1200.0, 0.01, 0.1}) {
            expect_bounds_hold(
                test::geographic_heightfield(Grid<float>(side, side, 50.0F), 50.0, 7.0, step), 1.0);
        }
    }
}

// A tile may span the whole Earth, so that its ends and its middle meet.
TEST(TileLayout, BoundsHoldAWholeGlobe) {
    for (const int cells : {2, 7, 20, 61, 90}) {
        expect_bounds_hold(test::closed_globe(cells, 0.5, 0.5, 3), 1.0);
        expect_bounds_hold(test::closed_globe(cells, 0.0, 0.0, 4), 5.0);
    }
}

TEST(TileLayout, TheReferenceIsTheMiddleOfTheRange) {
    const Heightfield heightfield =
        test::plane_heightfield(test::made_heights(2, 2, [](int col, int) { return 10.0 * col; }));
    EXPECT_DOUBLE_EQ(reference_height(heightfield), 5.0);
}

} // namespace
} // namespace reljef::terrain
