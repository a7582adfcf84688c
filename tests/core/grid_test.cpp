#include "engine/core/grid.h"

#include <array>
#include <climits>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace reljef {
namespace {

using testing::ElementsAre;

Grid<int> counted(int cols, int rows) {
    Grid<int> grid(cols, rows);
    std::iota(grid.samples().begin(), grid.samples().end(), 0);
    return grid;
}

TEST(Grid, LiesRowAfterRow) {
    const Grid<int> grid = counted(3, 2);
    EXPECT_THAT(grid.row(0), ElementsAre(0, 1, 2));
    EXPECT_THAT(grid.row(1), ElementsAre(3, 4, 5));
    EXPECT_EQ(grid(2, 0), 2);
    EXPECT_EQ(grid(0, 1), 3);
    EXPECT_EQ(grid.size(), 6U);
}

TEST(Grid, IsFilledWithTheGivenValue) {
    EXPECT_THAT(Grid<int>(2, 2, 9).samples(), ElementsAre(9, 9, 9, 9));
    EXPECT_THAT(Grid<int>(1, 2).samples(), ElementsAre(0, 0));
}

TEST(Grid, UnfilledTakesValuesLikeAnyOther) {
    auto grid = Grid<int>::unfilled(3, 2);
    EXPECT_EQ(grid.cols(), 3);
    EXPECT_EQ(grid.rows(), 2);
    std::iota(grid.samples().begin(), grid.samples().end(), 0);
    EXPECT_EQ(grid, counted(3, 2));
    EXPECT_TRUE(Grid<int>::unfilled(0, 5).empty());
}

TEST(Grid, IsEmptyWithoutColumnsOrRows) {
    EXPECT_TRUE(Grid<int>().empty());
    EXPECT_TRUE(Grid<int>(0, 5).empty());
    EXPECT_TRUE(Grid<int>(5, 0).view().empty());
    EXPECT_FALSE(Grid<int>(1, 1).empty());
}

TEST(Grid, ComparesShapeAndSamples) {
    EXPECT_EQ(counted(3, 2), counted(3, 2));
    EXPECT_NE(counted(3, 2), counted(2, 3));
    Grid<int> other = counted(3, 2);
    other(1, 1) = 0;
    EXPECT_NE(counted(3, 2), other);
}

TEST(Grid, ClampedReachesTheNearestSample) {
    const Grid<int> grid = counted(3, 2);
    for (int row = -3; row < 6; ++row) {
        for (int col = -3; col < 6; ++col) {
            const int nearest_col = col < 0 ? 0 : (col > 2 ? 2 : col);
            const int nearest_row = row < 0 ? 0 : (row > 1 ? 1 : row);
            EXPECT_EQ(grid.clamped(col, row), grid(nearest_col, nearest_row));
        }
    }
    EXPECT_EQ(grid.clamped(INT_MIN, INT_MAX), 3);
}

TEST(GridView, WritesThroughToItsGrid) {
    Grid<int> grid = counted(3, 2);
    grid.view()(1, 1) = 40;
    grid.row(0)[2] = 20;
    EXPECT_THAT(grid.samples(), ElementsAre(0, 1, 20, 3, 40, 5));
}

TEST(GridView, WindowOfAWindowKeepsTheStride) {
    Grid<int> grid = counted(6, 5);
    const GridView<const int> inner = grid.view().window(1, 1, 4, 3).window(1, 1, 2, 2);
    EXPECT_THAT(inner.row(0), ElementsAre(14, 15));
    EXPECT_THAT(inner.row(1), ElementsAre(20, 21));
    EXPECT_EQ(inner.clamped(9, 9), 21);
}

TEST(GridView, WindowMayTouchTheBordersAndBeEmpty) {
    const Grid<int> grid = counted(3, 2);
    EXPECT_EQ(grid.view().window(0, 0, 3, 2)(2, 1), 5);
    EXPECT_TRUE(grid.view().window(3, 2, 0, 0).empty());
}

TEST(GridDeathTest, WindowOutsideAborts) {
    const Grid<int> grid = counted(3, 2);
    EXPECT_DEATH((void)grid.view().window(1, 0, 3, 1), "window outside its grid");
    EXPECT_DEATH((void)grid.view().window(0, 1, 1, 2), "window outside its grid");
    EXPECT_DEATH((void)grid.view().window(-1, 0, 1, 1), "window outside its grid");
    EXPECT_DEATH((void)grid.view().window(2, 0, INT_MAX, 1), "window outside its grid");
}

TEST(GridDeathTest, NegativeSizeAborts) {
    EXPECT_DEATH(Grid<int>(-1, 2), "grid of a negative size");
    EXPECT_DEATH(Grid<int>(2, -1), "grid of a negative size");
}

TEST(GridDeathTest, OfMoreSamplesThanAnyMemoryAborts) {
    struct Wide {
        std::array<char, 64> bytes;
    };
    EXPECT_EXIT(Grid<Wide>(INT_MAX, INT_MAX), testing::KilledBySignal(SIGABRT),
                "grid larger than any memory");
}

} // namespace
} // namespace reljef
