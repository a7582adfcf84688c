#include "engine/terrain/mesh/triangle_error.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/terrain/field/heightfield.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::terrain {
namespace {

// A triangle of bisection: half a square, or a quarter of one.
SampleTriangle chance_triangle(test::Chance& chance, int size) {
    const glm::ivec2 first(chance.whole(0, 32 - size), chance.whole(0, 32 - size));
    const glm::ivec2 se = first + size;
    const glm::ivec2 ne(se.x, first.y);
    const glm::ivec2 sw(first.x, se.y);
    const glm::ivec2 middle = (first + se) / 2;
    switch (chance.whole(0, size > 1 ? 7 : 3)) {
    case 0:
        return {first, sw, se};
    case 1:
        return {ne, first, se};
    case 2:
        return {first, sw, ne};
    case 3:
        return {se, ne, sw};
    case 4:
        return {middle, first, sw};
    case 5:
        return {middle, sw, se};
    case 6:
        return {middle, se, ne};
    default:
        return {middle, ne, first};
    }
}

double difference_at(const Grid<float>& heights, const SampleTriangle& triangle, double u,
                     double v) {
    const glm::dvec2 a(triangle[0]);
    const glm::dvec2 at = a + u * (glm::dvec2(triangle[1]) - a) + v * (glm::dvec2(triangle[2]) - a);
    const auto corner = [&](std::size_t i) {
        return static_cast<double>(heights(triangle[i].x, triangle[i].y));
    };
    const double plane = corner(0) + u * (corner(1) - corner(0)) + v * (corner(2) - corner(0));
    return std::abs(bilinear_height(heights.view(), at) - plane);
}

// Along the diagonals lie the parabolas that samples alone would miss: they are among the points.
TEST(TriangleError, IsTheGreatestOfTheDifferencesAtAllPoints) {
    test::Chance chance(1);
    for (int i = 0; i < 400; ++i) {
        const Grid<float> heights =
            test::random_heights(33, 33, -10.0F, 10.0F, static_cast<unsigned>(i));
        const int size = 1 << chance.whole(0, 3);
        const SampleTriangle triangle = chance_triangle(chance, size);
        const int points = 16 * size;
        double greatest = 0.0;
        for (int j = 0; j <= points; ++j) {
            for (int k = 0; j + k <= points; ++k) {
                greatest = std::max(
                    greatest, difference_at(heights, triangle, 1.0 * j / points, 1.0 * k / points));
            }
        }
        const double found = triangle_error(heights.view(), triangle);
        ASSERT_GE(found, greatest - 1e-9);
        // Between points a 16th of a cell apart a parabola of twist <= 40 m rises by 40/32² m.
        ASSERT_LE(found, greatest + 40.0 / 1024.0);
    }
}

TEST(TriangleError, OfHalfACellIsAQuarterOfItsTwist) {
    Grid<float> heights(2, 2, 5.0F);
    heights(1, 0) = 13.0F;
    EXPECT_DOUBLE_EQ(triangle_error(heights.view(), {glm::ivec2(0, 0), {0, 1}, {1, 0}}), 2.0);
    EXPECT_DOUBLE_EQ(triangle_error(heights.view(), {glm::ivec2(0, 0), {0, 1}, {1, 1}}), 2.0);
}

TEST(TriangleError, IsNoneOnAPlane) {
    const Grid<float> heights =
        test::made_heights(17, 17, [](int col, int row) { return 3.0 * col - 0.5 * row; });
    EXPECT_EQ(triangle_error(heights.view(), {glm::ivec2(8, 8), {0, 0}, {0, 16}}), 0.0);
}

} // namespace
} // namespace reljef::terrain
