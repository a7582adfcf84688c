#include "engine/terrain/field/heightfield.h"

#include <cmath>
#include <random>

#include <glm/common.hpp>
#include <gtest/gtest.h>

namespace reljef::terrain {
namespace {

using Mask = Grid<std::uint8_t>;

Grid<float> plane(int cols, int rows, double a, double b, double c) {
    Grid<float> heights(cols, rows);
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
            heights(col, row) = static_cast<float>(a + b * col + c * row);
        }
    }
    return heights;
}

Grid<float> random_heights(int cols, int rows, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> values(-100.0F, 4000.0F);
    Grid<float> heights(cols, rows);
    for (float& height : heights.samples()) {
        height = values(random);
    }
    return heights;
}

TEST(HeightRange, LooksOnlyAtWhatIsNoVoid) {
    Grid<float> heights = plane(3, 2, 5.0, 1.0, 0.0);
    heights(0, 0) = -9999.0F;
    Mask mask(3, 2);
    mask(0, 0) = 1;
    EXPECT_EQ(height_range(heights, mask).low, 5.0);
    EXPECT_EQ(height_range(heights, mask).high, 7.0);
    EXPECT_EQ(height_range(heights, {}).low, -9999.0);
}

TEST(HeightRange, OfVoidsAloneIsZero) {
    const HeightRange range = height_range(plane(2, 2, 5.0, 1.0, 1.0), Mask(2, 2, 1));
    EXPECT_EQ(range.low, 0.0);
    EXPECT_EQ(range.high, 0.0);
}

TEST(BilinearHeight, AgreesWithItsDefinition) {
    const Grid<float> heights = random_heights(17, 9, 1);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> cols(0.0, 16.0);
    std::uniform_real_distribution<double> rows(0.0, 8.0);
    for (int i = 0; i < 20000; ++i) {
        const glm::dvec2 s(cols(random), rows(random));
        double expected = 0.0;
        for (int row = 0; row < 9; ++row) {
            for (int col = 0; col < 17; ++col) {
                expected += std::max(0.0, 1.0 - std::abs(s.x - col)) *
                            std::max(0.0, 1.0 - std::abs(s.y - row)) * heights(col, row);
            }
        }
        ASSERT_NEAR(bilinear_height(heights.view(), s), expected, 1e-9);
    }
}

TEST(BilinearHeight, IsExactAtSamples) {
    const Grid<float> heights = random_heights(5, 4, 3);
    for (int row = 0; row < 4; ++row) {
        for (int col = 0; col < 5; ++col) {
            ASSERT_EQ(bilinear_height(heights.view(), glm::dvec2(col, row)), heights(col, row));
        }
    }
}

TEST(BilinearHeight, IsClampedToTheGrid) {
    const Grid<float> heights = random_heights(5, 4, 4);
    EXPECT_EQ(bilinear_height(heights.view(), {-10.0, -1e300}), heights(0, 0));
    EXPECT_EQ(bilinear_height(heights.view(), {1e300, 3.0}), heights(4, 3));
    EXPECT_EQ(bilinear_height(heights.view(), {4.5, 1.0}), heights(4, 1));
    EXPECT_TRUE(std::isfinite(bilinear_height(heights.view(), {std::nan(""), 0.0})));
}

TEST(BilinearHeight, OfASingleSampleIsThatSample) {
    const Grid<float> heights(1, 1, 7.0F);
    EXPECT_EQ(bilinear_height(heights.view(), {0.3, 12.0}), 7.0);
}

TEST(SurfaceRange, HoldsAllHeightsBetweenTwoPlacesAndReachesTheExtremes) {
    const Grid<float> heights = random_heights(9, 7, 3);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> eighths(-16.0, 80.0); // partly beside the grid
    const auto place = [&] { return std::round(eighths(random)) / 8.0; };
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec2 a(place(), place());
        const glm::dvec2 b(place(), place());
        const glm::dvec2 first = glm::min(a, b);
        const glm::dvec2 last = glm::max(a, b);
        HeightRange expected{1e9, -1e9}; // extremes are at eighths, as the places are
        for (double row = first.y; row <= last.y; row += 0.125) {
            for (double col = first.x; col <= last.x; col += 0.125) {
                const double height = bilinear_height(heights.view(), {col, row});
                expected = {std::min(expected.low, height), std::max(expected.high, height)};
            }
        }
        const HeightRange found = surface_range(heights.view(), first, last);
        ASSERT_EQ(found.low, expected.low);
        ASSERT_EQ(found.high, expected.high);
    }
}

TEST(SurfaceRange, OfWholeCellsIsThatOfTheirVertices) {
    const Grid<float> heights = random_heights(9, 7, 5);
    const HeightRange found = surface_range(heights.view(), {2.0, 1.0}, {5.0, 6.0});
    HeightRange expected{1e9, -1e9};
    for (int row = 1; row <= 6; ++row) {
        for (int col = 2; col <= 5; ++col) {
            const double height = heights(col, row);
            expected = {std::min(expected.low, height), std::max(expected.high, height)};
        }
    }
    EXPECT_EQ(found.low, expected.low);
    EXPECT_EQ(found.high, expected.high);
}

TEST(TouchesVoid, ExactlyWhereTheVoidHasWeight) {
    Heightfield heightfield;
    heightfield.heights = Grid<float>(4, 4);
    heightfield.void_mask = Mask(4, 4);
    heightfield.void_mask(2, 1) = 1;
    EXPECT_TRUE(uses_void(heightfield, {2.0, 1.0}));
    EXPECT_TRUE(uses_void(heightfield, {1.01, 1.0}));
    EXPECT_TRUE(uses_void(heightfield, {2.99, 1.99}));
    EXPECT_TRUE(uses_void(heightfield, {1.5, 0.5}));
    EXPECT_FALSE(uses_void(heightfield, {1.0, 1.0}));
    EXPECT_FALSE(uses_void(heightfield, {3.0, 1.0}));
    EXPECT_FALSE(uses_void(heightfield, {2.5, 2.0}));
    EXPECT_FALSE(uses_void(heightfield, {2.0, 0.0}));
    heightfield.void_mask = Mask(4, 4);
    heightfield.void_mask(3, 3) = 1;
    EXPECT_TRUE(uses_void(heightfield, {3.0, 3.0}));
    EXPECT_FALSE(uses_void(heightfield, {2.0, 3.0}));
}

TEST(TouchesVoid, NeverWithoutAMask) {
    Heightfield heightfield;
    heightfield.heights = Grid<float>(4, 4);
    EXPECT_FALSE(uses_void(heightfield, {1.0, 1.0}));
}

TEST(FillVoids, LeavesKnownHeightsAlone) {
    const Grid<float> before = random_heights(37, 23, 5);
    std::mt19937 random(6);
    Mask mask(37, 23);
    for (std::uint8_t& is_void : mask.samples()) {
        is_void = random() % 3 == 0 ? 1 : 0;
    }
    Grid<float> after = before;
    fill_voids(after, mask);
    for (std::size_t i = 0; i < mask.size(); ++i) {
        if (mask.samples()[i] == 0) {
            ASSERT_EQ(after.samples()[i], before.samples()[i]);
        }
    }
}

TEST(FillVoids, StaysWithinTheKnownHeightsWhateverStoodThere) {
    for (unsigned seed = 0; seed < 200; ++seed) {
        std::mt19937 random(seed);
        const int cols = 2 + static_cast<int>(random() % 40);
        const int rows = 2 + static_cast<int>(random() % 40);
        Grid<float> heights = random_heights(cols, rows, seed);
        Mask mask(cols, rows);
        for (std::size_t i = 0; i < mask.size(); ++i) {
            if (random() % 100 < seed % 100) {
                mask.samples()[i] = 1;
                heights.samples()[i] = random() % 2 == 0 ? -32768.0F : std::nanf("");
            }
        }
        mask(0, 0) = 0;
        heights(0, 0) = 1.0F;
        const HeightRange range = height_range(heights, mask);
        fill_voids(heights, mask);
        for (const float height : heights.samples()) {
            ASSERT_GE(height, range.low - 1e-3);
            ASSERT_LE(height, range.high + 1e-3);
        }
    }
}

TEST(FillVoids, AHoleInALevelPlaneIsThatLevel) {
    Grid<float> heights(64, 64, 250.0F);
    Mask mask(64, 64);
    for (int row = 10; row < 40; ++row) {
        for (int col = 5; col < 50; ++col) {
            mask(col, row) = 1;
            heights(col, row) = -9999.0F;
        }
    }
    fill_voids(heights, mask);
    for (const float height : heights.samples()) {
        ASSERT_NEAR(height, 250.0F, 1e-3F);
    }
}

TEST(FillVoids, ASmallHoleInASlopeHasNoSpike) {
    const Grid<float> slope = plane(64, 64, 100.0, 10.0, -5.0);
    Grid<float> heights = slope;
    Mask mask(64, 64);
    for (int row = 30; row < 34; ++row) {
        for (int col = 30; col < 34; ++col) {
            mask(col, row) = 1;
            heights(col, row) = -32768.0F;
        }
    }
    fill_voids(heights, mask);
    for (int row = 30; row < 34; ++row) {
        for (int col = 30; col < 34; ++col) {
            ASSERT_NEAR(heights(col, row), slope(col, row), 40.0); // four samples of the slope
        }
    }
}

// A membrane is the plane over a hole in a plane; averages of an area made a bowl.
TEST(FillVoids, AWideHoleInASlopeHasNoBowl) {
    const Grid<float> slope = plane(128, 128, 100.0, 10.0, -5.0);
    Grid<float> heights = slope;
    Mask mask(128, 128);
    for (int row = 40; row < 90; ++row) {
        for (int col = 30; col < 90; ++col) {
            mask(col, row) = 1;
            heights(col, row) = -32768.0F;
        }
    }
    fill_voids(heights, mask);
    for (int row = 40; row < 90; ++row) {
        for (int col = 30; col < 90; ++col) {
            ASSERT_NEAR(heights(col, row), slope(col, row), 10.0) << col << ' ' << row;
        }
    }
}

TEST(FillVoids, AllVoidGivesZeroEverywhere) {
    Grid<float> heights(9, 5, -9999.0F);
    fill_voids(heights, Mask(9, 5, 1));
    for (const float height : heights.samples()) {
        ASSERT_EQ(height, 0.0F);
    }
}

TEST(FillVoids, ALineOfSamplesIsFilledToo) {
    Grid<float> heights(9, 1, 3.0F);
    Mask mask(9, 1);
    heights(4, 0) = std::nanf("");
    mask(4, 0) = 1;
    fill_voids(heights, mask);
    EXPECT_NEAR(heights(4, 0), 3.0F, 1e-6F);
}

} // namespace
} // namespace reljef::terrain
