#include "engine/terrain/field/sample_polynomial.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::terrain {
namespace {

// A hundredth of a pixel of 57 degrees over 1024.
constexpr double hundredth_pixel = 1e-5; // radians

Heightfield flat(double latitude, double step, double turn = 0.0) {
    return test::geographic_heightfield(Grid<float>(1201, 1201, 0.0F), latitude, 6.0, step, turn);
}

glm::dvec3 middle_of(const Placement& placement) {
    return placement.world_from_sample({600.0, 600.0, 500.0});
}

// At random places, its sample is where the place is.
void expect_error_is_the_largest(const Placement& placement, const SamplePolynomial& polynomial,
                                 glm::dvec3 half_size) {
    test::Chance chance(1);
    double largest = 0.0;
    for (int i = 0; i < 3000; ++i) {
        const glm::dvec3 offset =
            half_size *
            glm::dvec3(chance.between(-1, 1), chance.between(-1, 1), chance.between(-1, 1));
        const glm::dvec3 up = placement.up(polynomial.middle());
        const glm::dvec3 north = placement.north(polynomial.middle());
        const glm::dvec3 world = polynomial.middle() + offset.x * glm::cross(north, up) +
                                 offset.y * north + offset.z * up;
        const glm::dvec3 found = placement.world_from_sample(polynomial.at(world));
        largest = std::max(largest, glm::distance(found, world));
    }
    // Positions are rounded at 1e-8 m.
    EXPECT_LE(largest, 1.1 * polynomial.error() + 2e-8);
    EXPECT_GE(largest, 0.1 * polynomial.error() - 2e-8);
}

TEST(SamplePolynomial, AHundredKilometresAroundAnEyeHaveNoVisibleError) {
    const glm::dvec3 half_size(1e5, 1e5, 5e3);
    for (const double latitude : {2.0, 47.0, -58.0, 72.0}) {
        const Heightfield heightfield = flat(latitude, 1.0 / 300.0, 20.0);
        const Placement placement = test::placed(heightfield, 2.0);
        const glm::dvec3 eye = middle_of(placement);
        const auto polynomial = SamplePolynomial::create(placement, eye, half_size);
        ASSERT_TRUE(polynomial) << latitude;
        EXPECT_LT(polynomial->angle_from(eye + glm::dvec3(0.0, 0.0, 0.3)), hundredth_pixel)
            << latitude;
        EXPECT_LT(glm::distance(placement.world_from_sample(polynomial->at(eye)), eye), 2e-8);
        expect_error_is_the_largest(placement, *polynomial, half_size);
    }
}

TEST(SamplePolynomial, OfAPlaneIsTheMap) {
    const Heightfield heightfield =
        test::plane_heightfield(Grid<float>(101, 51, 0.0F), {30.0, 20.0});
    const Placement placement = test::placed(heightfield, 3.0);
    const auto polynomial =
        SamplePolynomial::create(placement, {10.0, 20.0, 30.0}, {1e3, 2e3, 3e2});
    ASSERT_TRUE(polynomial);
    EXPECT_LT(polynomial->error(), 1e-9);
    expect_error_is_the_largest(placement, *polynomial, {1e3, 2e3, 3e2});
}

TEST(SamplePolynomial, ColumnsContinueAcrossTheAntimeridian) {
    const Heightfield globe = test::closed_globe(360, 0.5, 0.5, 1);
    const Placement placement = test::placed(globe);
    const double last = globe.heights.cols() - 1.0;
    const glm::dvec3 middle = placement.world_from_sample({last, 180.0, 0.0});
    const glm::dvec3 half_size(1e5, 1e5, 5e3);
    const auto polynomial = SamplePolynomial::create(placement, middle, half_size);
    ASSERT_TRUE(polynomial);
    EXPECT_LT(polynomial->error(), 1.0);
    expect_error_is_the_largest(placement, *polynomial, half_size);
}

// Columns meet at a pole: no polynomial knows their places.
TEST(SamplePolynomial, AcrossAPoleItStatesThatItIsWrong) {
    const Heightfield globe = test::closed_globe(360, 0.5, 0.5, 1);
    const Placement placement = test::placed(globe);
    const glm::dvec3 middle = placement.world_from_sample({100.0, 2.0, 0.0});
    const auto polynomial = SamplePolynomial::create(placement, middle, {3e5, 3e5, 1e4});
    EXPECT_TRUE(!polynomial || polynomial->error() > 1e4);
}

} // namespace
} // namespace reljef::terrain
