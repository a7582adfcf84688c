#include "engine/view/rays/degree_course.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::view {
namespace {

struct DegreesAt {
    double latitude = 0.0;  ///< of the first row
    double step = 0.01;     ///< degrees
    double height = 1000.0; ///< of the eye, metres
};

// A turned terrain has samples beyond a pole.
double turn_at(double latitude) {
    return std::abs(latitude) < 80.0 ? 10.0 : 0.0;
}

// Of places around, from the ground to 9 km, the largest angle between them and those found.
double largest_angle(const DegreesAt& at, bool in_floats) {
    constexpr int side = 101;
    const terrain::Placement placement =
        test::placed(test::geographic_heightfield(Grid<float>(side, side, 0.0F), at.latitude, 6.0,
                                                  at.step, turn_at(at.latitude)),
                     1.5);
    const glm::dmat4 world_from_local =
        glm::rotate(glm::translate(glm::dmat4(1.0), glm::dvec3(1e3, -2e3, 50.0)), 0.7,
                    glm::dvec3(0.0, 0.0, 1.0));
    const glm::dmat3 turn(world_from_local);
    const glm::dvec3 eye = placement.world_from_sample({30.0, 40.0, at.height / 1.5});
    const auto course = degree_course(eye, glm::inverse(turn), placement, 50.0);
    if (!course) {
        ADD_FAILURE() << "no course";
        return 1.0;
    }
    test::Chance chance(5);
    double largest = 0.0;
    for (int i = 0; i < 2000; ++i) {
        const double share = std::pow(chance.between(0.0, 1.0), 3.0); // many near the eye
        const glm::dvec3 sample(30.0 + share * chance.between(-30.0, 70.0),
                                40.0 + share * chance.between(-40.0, 60.0),
                                chance.between(0.0, 6000.0));
        const glm::dvec3 place = placement.world_from_sample(sample);
        const glm::dvec3 way = turn * (place - eye);
        const glm::dvec3 found = placement.world_from_sample(
            in_floats ? course->sample_in_floats(way) : course->sample(way));
        largest = std::max(largest, glm::distance(found, place) / glm::length(way));
    }
    return largest;
}

TEST(DegreeCourse, FindsTheSampleOfAnyPlace) {
    for (const double latitude : {90.0, 89.9, 70.0, 0.5, -40.0, -88.9}) {
        for (const double height : {0.3, 1e3, 1e5, 1e7}) {
            EXPECT_LT(largest_angle({latitude, 0.01, height}, false), 1e-10)
                << latitude << ", " << height;
        }
    }
    for (const double height : {30.0, 1e6}) {
        EXPECT_LT(largest_angle({85.0, 1.7, height}, false), 1e-10) << height; // half of the Earth
    }
}

// A hundredth of a pixel is about 1e-5.
TEST(DegreeCourse, FindsItWithFloatsAsFarAsFloatsHaveDigits) {
    for (const double latitude : {90.0, 89.99, 70.0, -88.9}) {
        for (const double step : {1e-4, 0.01}) {
            for (const double height : {0.3, 1e3, 1e5, 1e7}) {
                EXPECT_LT(largest_angle({latitude, step, height}, true), 2e-6)
                    << latitude << ", " << step << ", " << height;
            }
        }
    }
}

TEST(DegreeCourse, IsThereForTerrainInDegreesWithoutAGeoidOnly) {
    terrain::Heightfield ground =
        test::geographic_heightfield(Grid<float>(9, 9, 0.0F), 45.0, 6.0, 0.01);
    const auto is_there = [](const terrain::Heightfield& heightfield, double height) {
        const terrain::Placement placement = test::placed(heightfield);
        const glm::dvec3 eye = placement.world_from_sample({4.0, 4.0, height});
        return degree_course(eye, glm::dmat3(1.0), placement, 4.0).has_value();
    };
    EXPECT_TRUE(is_there(ground, 100.0));
    EXPECT_FALSE(is_there(ground, -1.1e5));
    terrain::Heightfield over_geoid = ground;
    over_geoid.georeference->geoid =
        geo::Geoid("made", Grid<float>(20, 20, 30.0F), {42.0, 4.0}, {0.25, 0.25});
    EXPECT_FALSE(is_there(over_geoid, 100.0));
    Grid<glm::dvec2> bent(4, 4);
    for (int row = 0; row < 4; ++row) {
        for (int col = 0; col < 4; ++col) {
            bent(col, row) = {45.0 - 0.04 * row, 6.0 + 0.04 * col + 0.001 * col * row};
        }
    }
    ground.georeference->geodetic = geo::GeodeticMap(bent, {0.0, 0.0}, {4.0, 4.0});
    EXPECT_FALSE(is_there(ground, 100.0));
}

} // namespace
} // namespace reljef::view
