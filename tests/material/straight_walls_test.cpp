#include "engine/material/straight_walls.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <gtest/gtest.h>

#include "engine/terrain/field/heightfield.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::material {
namespace {

constexpr double roof = 12.0; // metres above the ground
constexpr int wall_side = 96;

// A straight wall through the middle; samples lie on the roof or on the ground.
struct Wall {
    glm::dvec2 normal; // into the roof
    glm::dvec2 middle{0.5 * wall_side, 0.5 * wall_side};

    [[nodiscard]] Grid<float> heights() const {
        return test::made_heights(wall_side, wall_side, [&](int col, int row) {
            return glm::dot(glm::dvec2(col, row) - middle, normal) > 0.0 ? roof : 0.0;
        });
    }

    // Standard deviation of the place of the half height along the wall, samples.
    [[nodiscard]] double wobble(const Grid<float>& heights) const {
        const glm::dvec2 along(normal.y, -normal.x);
        std::vector<double> places;
        for (double s = -30.0; s <= 30.0; s += 0.37) {
            double away = -2.0;
            while (terrain::bilinear_height(heights.view(), middle + s * along + away * normal) <
                   0.5 * roof) {
                away += 0.01;
            }
            places.push_back(away);
        }
        const double mean =
            std::accumulate(places.begin(), places.end(), 0.0) / static_cast<double>(places.size());
        double square = 0.0;
        for (const double place : places) {
            square += (place - mean) * (place - mean);
        }
        return std::sqrt(square / static_cast<double>(places.size()));
    }
};

TEST(StraightWalls, WobbleLessThanHalfAsMuch) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> degrees(0.0, 360.0);
    std::uniform_real_distribution<double> shift(-1.0, 1.0);
    double before = 0.0;
    double after = 0.0;
    for (int i = 0; i < 200; ++i) {
        const double angle = degrees(random) * std::acos(-1.0) / 180.0;
        const Wall wall{{std::cos(angle), std::sin(angle)},
                        {0.5 * wall_side + shift(random), 0.5 * wall_side + shift(random)}};
        const Grid<float> heights = wall.heights();
        const StraightWalls made = straight_walls(heights.view(), {}, wall_height);
        const double stepped = wall.wobble(heights);
        const double straight = wall.wobble(made.heights);
        EXPECT_LE(straight, stepped + 0.02) << angle;
        before += stepped;
        after += straight;
    }
    EXPECT_LT(after, 0.5 * before);
}

// No sample of the roof is lower than half of it, and none of the ground is higher.
TEST(StraightWalls, SamplesStayOnTheirSide) {
    for (unsigned seed = 0; seed < 100; ++seed) {
        std::mt19937 random(seed);
        std::uniform_int_distribution<int> coin(0, 3);
        const Grid<float> heights =
            test::made_heights(24, 20, [&](int, int) { return coin(random) == 0 ? roof : 0.0; });
        const StraightWalls made = straight_walls(heights.view(), {}, wall_height);
        for (std::size_t i = 0; i < heights.samples().size(); ++i) {
            const bool is_roof = heights.samples()[i] > 6.0F;
            ASSERT_TRUE(is_roof ? made.heights.samples()[i] >= 6.0F
                                : made.heights.samples()[i] <= 6.0F);
        }
    }
}

TEST(StraightWalls, SlopesPostsVoidsAndAveragedWallsKeepTheirHeights) {
    const auto is_kept = [](const Grid<float>& heights, const Grid<std::uint8_t>& voids = {}) {
        const StraightWalls made = straight_walls(heights.view(), voids, wall_height);
        return made.changed == 0 && made.heights == heights;
    };
    EXPECT_TRUE(
        is_kept(test::made_heights(30, 30, [](int col, int row) { return 1.2 * col + row; })));
    EXPECT_TRUE(is_kept(test::made_heights(
        30, 30, [](int col, int row) { return col == 15 && row == 15 ? 40.0 : 0.0; })));
    EXPECT_TRUE(is_kept(test::made_heights(
        30, 30, [](int col, int /*row*/) { return std::clamp(6.0 * (col - 15), 0.0, 12.0); })));
    const Wall wall{glm::normalize(glm::dvec2(3.0, 1.0))};
    EXPECT_FALSE(is_kept(wall.heights())) << "else this test finds nothing";
    EXPECT_TRUE(is_kept(wall.heights(), Grid<std::uint8_t>(wall_side, wall_side, 1)));
    EXPECT_TRUE(is_kept(Grid<float>(2, 2, 1.0F)));
    EXPECT_TRUE(is_kept(Grid<float>(1, 9, 1.0F)));
}

TEST(StraightWalls, AreTheSameOnAnyNumberOfThreadsAndStop) {
    const Grid<float> heights = Wall{glm::normalize(glm::dvec2(2.0, 7.0))}.heights();
    const StraightWalls one = straight_walls(heights.view(), {}, wall_height, {1, {}, {}});
    EXPECT_EQ(one.heights, straight_walls(heights.view(), {}, wall_height, {3, {}, {}}).heights);
    std::stop_source stopped;
    stopped.request_stop();
    EXPECT_TRUE(straight_walls(heights.view(), {}, wall_height, {1, stopped.get_token(), {}})
                    .heights.empty());
}

} // namespace
} // namespace reljef::material
