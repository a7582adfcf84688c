#include "engine/terrain/mesh/sample_positions.h"

#include <algorithm>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/terrain/made_bisection.h"

namespace reljef::terrain {
namespace {

using test::rough_hills;

// Twice the largest second difference along columns, rows and both, metres/sample².
double curvature_of(const Heightfield& heightfield, const Placement& placement) {
    const auto at = [&](int col, int row) {
        return placement.world_from_sample({col, row, heightfield.range.high});
    };
    double largest = 0.0;
    for (int row = 1; row + 2 < heightfield.heights.rows(); ++row) {
        for (int col = 1; col + 2 < heightfield.heights.cols(); ++col) {
            const glm::dvec3 here = at(col, row);
            largest = std::max(
                {largest, glm::length(at(col - 1, row) - 2.0 * here + at(col + 1, row)),
                 glm::length(at(col, row - 1) - 2.0 * here + at(col, row + 1)),
                 glm::length(here - at(col + 1, row) - at(col, row + 1) + at(col + 1, row + 1))});
        }
    }
    return 2.0 * largest;
}

double largest_error(const SamplePositions& positions, const Heightfield& heightfield,
                     const Placement& placement) {
    double largest = 0.0;
    for (int row = 0; row < heightfield.heights.rows(); ++row) {
        for (int col = 0; col < heightfield.heights.cols(); ++col) {
            const double height = heightfield.heights(col, row);
            const glm::dvec3 exact = placement.world_from_sample({col, row, height});
            largest = std::max(largest, glm::distance(exact, positions.at({col, row}, height)));
        }
    }
    return largest;
}

constexpr double rounding = 1e-6; // metres: positions on the Earth are rounded at 1e-8

TEST(SamplePositions, AreExactOnAPlane) {
    for (const glm::ivec2 size : {glm::ivec2(2, 2), {2, 90}, {77, 3}, {161, 130}}) {
        const Heightfield hills =
            test::plane_heightfield(rough_hills(size.x, size.y, 1), {5.0, 7.0});
        const Placement placement = test::placed(hills, 3.0);
        const SamplePositions positions(hills, placement, 0.0, 1.0);
        EXPECT_EQ(positions.error(), 0.0);
        EXPECT_EQ(largest_error(positions, hills, placement), 0.0);
    }
}

// Steps of 25 m to 110 km, at the equator, at a pole, and turned.
TEST(SamplePositions, AreWithinTheirErrorOnTheEarth) {
    struct Case {
        glm::ivec2 size;
        double latitude;
        double step;
        double turn;
    };
    for (const Case& made : {Case{{161, 130}, 46.0, 3e-4, 0.0}, Case{{161, 130}, 0.01, 3e-4, 30.0},
                             Case{{150, 140}, 89.9, 8e-4, 0.0}, Case{{90, 70}, 60.0, 0.1, 0.0},
                             Case{{120, 60}, 80.0, 1.0, 0.0}, Case{{2, 2}, 10.0, 0.01, 0.0},
                             Case{{33, 4}, -45.0, 0.01, 0.0}}) {
        const Heightfield earth = test::geographic_heightfield(
            rough_hills(made.size.x, made.size.y, 4), made.latitude, 7.0, made.step, made.turn);
        const Placement placement = test::placed(earth, 2.0);
        const double curvature = curvature_of(earth, placement);
        for (const double max_error : {1e-3, 1.0, 1e3, 1e9}) {
            const SamplePositions positions(earth, placement, curvature, max_error);
            EXPECT_LE(positions.error(), max_error);
            EXPECT_LE(largest_error(positions, earth, placement), positions.error() + rounding)
                << made.latitude << ' ' << made.step << ' ' << max_error;
        }
    }
}

// The last cells of a tile are shorter where its terrain ends.
TEST(SamplePositions, AreWithinTheirErrorWhereTheLastCellsAreShorter) {
    const Heightfield earth =
        test::geographic_heightfield(rough_hills(160, 160, 6), 46.0, 7.0, 0.01);
    const Placement whole = test::placed(earth);
    const Placement tile = whole.of_tile({1, {}, {}}, {{8.0, 16.0}, {131.0, 159.0}, 2.0, {62, 72}});
    const Heightfield of_tile = test::plane_heightfield(rough_hills(63, 73, 7));
    const double curvature = 16.0 * curvature_of(earth, whole); // two samples a step, and room
    const SamplePositions positions(of_tile, tile, curvature, 1e9);
    EXPECT_LE(largest_error(positions, of_tile, tile), positions.error() + rounding);
}

} // namespace
} // namespace reljef::terrain
