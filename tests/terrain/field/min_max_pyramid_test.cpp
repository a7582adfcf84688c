#include "engine/terrain/field/min_max_pyramid.h"

#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/terrain/made_heightfield.h"

namespace reljef::terrain {
namespace {

MinMax brute_force(const Grid<float>& heights, int level, int col, int row) {
    MinMax bounds{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};
    for (int r = row << level; r <= std::min((row + 1) << level, heights.rows() - 1); ++r) {
        for (int c = col << level; c <= std::min((col + 1) << level, heights.cols() - 1); ++c) {
            bounds.low = std::min(bounds.low, heights(c, r));
            bounds.high = std::max(bounds.high, heights(c, r));
        }
    }
    return bounds;
}

int blocks(int cells, int level) {
    return (cells + (1 << level) - 1) >> level;
}

TEST(MinMaxPyramid, EveryBlockHasTheExactBoundsWhateverTheSize) {
    std::mt19937 random(7);
    std::uniform_int_distribution<int> side(2, 90);
    for (unsigned round = 0; round < 60; ++round) {
        const Grid<float> heights =
            test::random_heights(side(random), side(random), -100.0F, 100.0F, round);
        const MinMaxPyramid pyramid(heights.view());
        for (int level = 1; level <= pyramid.last_level(); ++level) {
            const Grid<MinMax>& bounds = pyramid.level(level);
            ASSERT_EQ(bounds.cols(), blocks(heights.cols() - 1, level));
            ASSERT_EQ(bounds.rows(), blocks(heights.rows() - 1, level));
            for (int row = 0; row < bounds.rows(); ++row) {
                for (int col = 0; col < bounds.cols(); ++col) {
                    const MinMax expected = brute_force(heights, level, col, row);
                    ASSERT_EQ(bounds(col, row).low, expected.low);
                    ASSERT_EQ(bounds(col, row).high, expected.high);
                }
            }
        }
    }
}

TEST(MinMaxPyramid, TheLastLevelIsOneBlockOverAll) {
    for (const auto& [cols, rows] : {std::pair{2, 2}, {2, 1000}, {1000, 2}, {129, 130}, {3, 5}}) {
        const Grid<float> heights = test::random_heights(cols, rows, -5.0F, 5.0F, 3);
        const MinMaxPyramid pyramid(heights.view());
        EXPECT_EQ(pyramid.level(pyramid.last_level()).size(), 1U);
        const auto [low, high] =
            std::minmax_element(heights.samples().begin(), heights.samples().end());
        EXPECT_EQ(pyramid.total().low, *low);
        EXPECT_EQ(pyramid.total().high, *high);
    }
}

TEST(MinMaxPyramid, ReadsAWindowOfALargerGrid) {
    const Grid<float> heights = test::random_heights(40, 30, 0.0F, 1.0F, 5);
    const GridView<const float> window = heights.view().window(3, 4, 17, 9);
    const MinMaxPyramid pyramid(window);
    ASSERT_EQ(pyramid.level(1).cols(), 8);
    EXPECT_EQ(
        pyramid.level(1)(5, 1).low,
        std::min({heights(13, 6), heights(14, 6), heights(15, 6), heights(13, 7), heights(14, 7),
                  heights(15, 7), heights(13, 8), heights(14, 8), heights(15, 8)}));
}

TEST(MinMaxPyramid, BoundsAnyCells) {
    std::mt19937 random(11);
    const auto below = [&](int end) {
        return std::uniform_int_distribution<int>(0, end - 1)(random);
    };
    for (unsigned round = 0; round < 200; ++round) {
        const glm::ivec2 samples(2 + below(70), 2 + below(70));
        const Grid<float> heights =
            test::random_heights(samples.x, samples.y, -100.0F, 100.0F, round);
        const MinMaxPyramid pyramid(heights.view());
        const glm::ivec2 first(below(samples.x - 1), below(samples.y - 1));
        const glm::ivec2 last(first.x + below(samples.x - 1 - first.x),
                              first.y + below(samples.y - 1 - first.y));
        const MinMax bounds = pyramid.bounds(first, last);
        for (int row = first.y; row <= last.y + 1; ++row) {
            for (int col = first.x; col <= last.x + 1; ++col) {
                ASSERT_GE(heights(col, row), bounds.low);
                ASSERT_LE(heights(col, row), bounds.high);
            }
        }
    }
}

TEST(MinMaxPyramidDeathTest, NeedsACell) {
    const Grid<float> heights(1, 5);
    EXPECT_DEATH(MinMaxPyramid(heights.view()), "at least 2x2");
}

} // namespace
} // namespace reljef::terrain
