#include "engine/terrain/field/gradient.h"

#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/terrain/made_heightfield.h"

namespace reljef::terrain {
namespace {

TEST(Gradient, OfLevelGroundIsZero) {
    const Heightfield heightfield = test::plane_heightfield(Grid<float>(7, 5, 1234.5F), {3.0, 4.0});
    const auto gradients = surface_gradients(heightfield, test::placed(heightfield));
    for (const glm::vec2& gradient : gradients.samples()) {
        EXPECT_EQ(gradient, glm::vec2(0.0F));
    }
}

TEST(Gradient, OfARampIsExactEverywhereTheBorderToo) {
    const Heightfield heightfield = test::plane_heightfield(
        test::made_heights(9, 6, [](int col, int row) { return 3.0 * col - 5.0 * row; }),
        {2.0, 4.0});
    const auto gradients = surface_gradients(heightfield, test::placed(heightfield, 2.0));
    for (const glm::vec2& gradient : gradients.samples()) {
        EXPECT_EQ(gradient, glm::vec2(3.0F, 2.5F)) << "rises to the east and to the north";
    }
}

TEST(Gradient, OfTwoByTwoIsOneSided) {
    Grid<float> heights(2, 2, 0.0F);
    heights(1, 0) = 6.0F;
    const Heightfield heightfield = test::plane_heightfield(heights, {2.0, 3.0});
    const auto gradients = surface_gradients(heightfield, test::placed(heightfield));
    EXPECT_EQ(gradients(0, 0), glm::vec2(3.0F, 0.0F));
    EXPECT_EQ(gradients(1, 1), glm::vec2(0.0F, 2.0F));
}

// Slope of the plane through the neighbours as they are placed.
glm::dvec2 slope_of_placed(const Heightfield& heightfield, const Placement& placement, int col,
                           int row) {
    const auto place = [&](int c, int r) {
        return placement.world_from_sample({c, r, heightfield.heights(c, r)});
    };
    const glm::dvec3 east = place(col + 1, row) - place(col - 1, row);
    const glm::dvec3 north = place(col, row - 1) - place(col, row + 1);
    const glm::dvec3 normal = glm::cross(east, north);
    return glm::dvec2(-normal.x, -normal.y) / normal.z;
}

void expect_slopes_of_placed(const Heightfield& heightfield, double exaggeration,
                             double tolerance) {
    const Placement placement = test::placed(heightfield, exaggeration);
    const auto gradients = surface_gradients(heightfield, placement);
    for (int row = 1; row < gradients.rows() - 1; row += 7) {
        for (int col = 1; col < gradients.cols() - 1; col += 7) {
            const glm::dvec2 expected = slope_of_placed(heightfield, placement, col, row);
            const glm::dvec2 found(gradients(col, row));
            ASSERT_LE(glm::distance(found, expected), tolerance * (1.0 + glm::length(expected)))
                << col << ' ' << row << ": " << found.x << ' ' << found.y << ", expected "
                << expected.x << ' ' << expected.y;
        }
    }
}

double hills(int col, int row) {
    return 900.0 * std::sin(0.21 * col) * std::cos(0.17 * row);
}

TEST(Gradient, OnAnEllipsoidIsThatOfThePlacedSurface) {
    expect_slopes_of_placed(
        test::geographic_heightfield(test::made_heights(201, 151, hills), 46.5, 7.0, 1.0 / 240.0),
        1.0, 1e-3);
    expect_slopes_of_placed(test::geographic_heightfield(test::made_heights(201, 151, hills), -33.0,
                                                         179.5, 1.0 / 240.0),
                            3.0, 1e-3);
}

// 30° of latitude in one raster: a degree of longitude is twice as long in the south as in the
// north.
TEST(Gradient, UsesTheLengthOfADegreeWhereItIs) {
    expect_slopes_of_placed(
        test::geographic_heightfield(
            test::made_heights(301, 301, [](int col, int row) { return 50.0 * hills(col, row); }),
            70.0, 0.0, 0.1),
        1.0, 2e-2);
}

TEST(Gradient, OfTheSeaFallsAwayWithTheEarth) {
    const Heightfield sea =
        test::geographic_heightfield(Grid<float>(201, 201, 0.0F), 1.0, 0.0, 0.01);
    const auto gradients = surface_gradients(sea, test::placed(sea));
    EXPECT_NEAR(gradients(100, 100).x, 0.0F, 1e-6F);
    EXPECT_NEAR(gradients(100, 100).y, 0.0F, 1e-6F);
    EXPECT_NEAR(gradients(200, 100).x, -std::tan(glm::radians(1.0)), 1e-4);
    EXPECT_NEAR(gradients(100, 0).y, -std::tan(glm::radians(1.0)), 2e-4);
}

TEST(Gradient, StaysFiniteBeyondTheHorizonOfAWholeEarth) {
    const Heightfield earth =
        test::geographic_heightfield(Grid<float>(360, 180, 10.0F), 89.5, -179.5, 1.0);
    const auto gradients = surface_gradients(earth, test::placed(earth));
    for (const glm::vec2& gradient : gradients.samples()) {
        ASSERT_TRUE(std::isfinite(gradient.x) && std::isfinite(gradient.y))
            << "sample " << &gradient - gradients.samples().data();
    }
}

} // namespace
} // namespace reljef::terrain
