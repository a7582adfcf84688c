#include "engine/terrain/light/sky_share.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/terrain/made_heightfield.h"

namespace reljef::terrain {
namespace {

double share_at(const Grid<float>& heights, glm::dvec2 spacing, double exaggeration = 1.0) {
    return sky_share(heights.view(), spacing, exaggeration)(heights.cols() / 2,
                                                            heights.rows() / 2) /
           255.0;
}

TEST(SkyShare, OfLevelGroundIsAll) {
    EXPECT_EQ(share_at(Grid<float>(33, 17, 250.0F), {30.0, 30.0}), 1.0);
}

// The closed form of an inclined plane, for 16 directions on two shapes of cells.
TEST(SkyShare, OfAPlaneIsHalfOfOnePlusTheCosine) {
    for (const double slope : {0.1, 0.5, 1.0, 2.0}) {
        for (const double azimuth : {0.0, 0.3, 0.785, 1.2, 1.571, 2.5, 4.0}) {
            for (const glm::dvec2 spacing : {glm::dvec2(10.0, 10.0), glm::dvec2(7.0, 10.0)}) {
                const auto heights = test::made_heights(41, 41, [&](int col, int row) {
                    return slope * (std::cos(azimuth) * col * spacing.x +
                                    std::sin(azimuth) * row * spacing.y);
                });
                const double expected = 0.5 * (1.0 + 1.0 / std::hypot(1.0, slope));
                EXPECT_NEAR(share_at(heights, spacing), expected, 0.012)
                    << slope << ' ' << azimuth << ' ' << spacing.x;
            }
        }
    }
}

// A street between endless walls of height h at a distance d: along an azimuth a from the street,
// the walls rise by s = h |sin a| / d, and the mean of 1 / (1 + s²) is 1 / sqrt(1 + (h / d)²).
TEST(SkyShare, OfAStreetIsThatOfItsWalls) {
    const auto heights = test::made_heights(
        401, 401, [](int col, int) { return std::abs(col - 200) > 9 ? 10.0 : 0.0; });
    EXPECT_NEAR(share_at(heights, {1.0, 1.0}), 1.0 / std::sqrt(2.0), 0.02);
    EXPECT_NEAR(share_at(heights, {1.0, 1.0}, 2.0), 1.0 / std::sqrt(5.0), 0.03);
}

TEST(SkyShare, IsTheSameForTurnedGround) {
    const Grid<float> heights = test::random_heights(25, 25, 0.0F, 9.0F, 3);
    const Grid<float> turned =
        test::made_heights(25, 25, [&](int col, int row) { return heights(row, 24 - col); });
    const auto a = sky_share(heights.view(), {2.0, 2.0}, 1.0);
    const auto b = sky_share(turned.view(), {2.0, 2.0}, 1.0);
    for (int row = 0; row < 25; ++row) {
        for (int col = 0; col < 25; ++col) {
            ASSERT_NEAR(b(col, row), a(row, 24 - col), 1);
        }
    }
}

// Each horizon is that of all samples along its line.
TEST(SkyShare, IsThatOfEverySampleOnTheLines) {
    const Grid<float> heights = test::random_heights(19, 1, 0.0F, 30.0F, 9);
    const auto found = sky_share(heights.view(), {5.0, 5.0}, 1.0);
    for (int col = 0; col < 19; ++col) {
        double west = 0.0;
        double east = 0.0;
        for (int other = 0; other < 19; ++other) {
            const double slope = (heights(other, 0) - heights(col, 0)) / (5.0 * (other - col));
            west = other < col ? std::max(west, -slope) : west;
            east = other > col ? std::max(east, slope) : east;
        }
        // Those along the row stand for the azimuths up to half way to the next ones, 26.565
        // degrees off.
        const double weight = std::atan(0.5) / (2.0 * std::acos(-1.0));
        const double expected =
            1.0 - weight * (2.0 - 1.0 / (1.0 + west * west) - 1.0 / (1.0 + east * east));
        ASSERT_NEAR(found(col, 0) / 255.0, expected, 0.003) << col;
    }
}

// Half of the azimuths, whose lines run through samples.
constexpr std::array<glm::ivec2, 8> line_steps{
    {{1, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 1}, {-1, 2}, {-1, 1}, {-2, 1}}};

// The steepest slope up to the samples on a line from a sample.
double steepest_along(const Grid<float>& heights, glm::ivec2 from, glm::ivec2 step) {
    double steepest = 0.0;
    const double length = glm::length(glm::dvec2(step));
    int steps = 1;
    for (glm::ivec2 at = from + step;
         at.x >= 0 && at.y >= 0 && at.x < heights.cols() && at.y < heights.rows(); at += step) {
        const double rise = heights(at.x, at.y) - heights(from.x, from.y);
        steepest = std::max(steepest, rise / (length * steps++));
    }
    return steepest;
}

// Grids smaller and larger than what is swept side by side, with lines that begin at each border.
TEST(SkyShare, IsThatOfAllSamplesOnSixteenLines) {
    constexpr double pi = std::numbers::pi;
    for (const glm::ivec2 size : {glm::ivec2(1, 1), {5, 50}, {23, 37}, {600, 31}, {31, 600}}) {
        const Grid<float> heights =
            test::random_heights(size.x, size.y, 0.0F, size.x == 23 ? 300.0F : 3.0F, 5);
        const auto found = sky_share(heights.view(), {1.0, 1.0}, 1.0);
        for (int row = 0; row < size.y; ++row) {
            for (int col = 0; col < size.x; ++col) {
                double expected = 0.0;
                for (std::size_t i = 0; i < 8; ++i) {
                    const auto angle = [](glm::ivec2 step) { return std::atan2(step.y, step.x); };
                    const double next = i < 7 ? angle(line_steps[i + 1]) : pi;
                    const double last = i > 0 ? angle(line_steps[i - 1]) : angle({2, -1});
                    for (const int sign : {-1, 1}) {
                        const double slope =
                            steepest_along(heights, {col, row}, sign * line_steps[i]);
                        expected += 0.25 * (next - last) / pi / (1.0 + slope * slope);
                    }
                }
                ASSERT_NEAR(found(col, row) / 255.0, expected, 0.51 / 255.0)
                    << col << ' ' << row << " of " << size.x << ' ' << size.y;
            }
        }
    }
}

} // namespace
} // namespace reljef::terrain
