#include "engine/cast/sun_course.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::cast {
namespace {

constexpr int samples_a_side = 401;

struct CoursePlace {
    double latitude = 46.0;
    double step = 0.0025; // degrees
    double turn = 0.0;    // degrees
    bool has_geoid = false;
};

terrain::Placement placement_at(const CoursePlace& place) {
    terrain::Heightfield heightfield = test::geographic_heightfield(
        test::made_heights(samples_a_side, samples_a_side,
                           [](int col, int /*row*/) { return 5.0 * col; }),
        place.latitude, 6.0, place.step, place.turn);
    if (place.has_geoid) { // as rough as over mountains
        Grid<float> undulation = test::made_heights(30, 30, [](int col, int row) {
            return 50.0 + 0.7 * col + 0.5 * std::sin(1.3 * col + 0.4 * row) * std::cos(0.9 * row);
        });
        heightfield.georeference->geoid =
            geo::Geoid("made", std::move(undulation), {42.0, 4.0}, {0.25, 0.25});
    }
    return test::placed(heightfield);
}

Box ground_up_to(double height) {
    Box box;
    box.add(glm::dvec3(0.0));
    box.add(glm::dvec3(samples_a_side - 1.0, samples_a_side - 1.0, height));
    return box;
}

glm::dvec3 sun_at(double azimuth, double altitude) {
    const double turn = glm::radians(azimuth);
    const double up = glm::radians(altitude);
    return {std::sin(turn) * std::cos(up), std::cos(turn) * std::cos(up), std::sin(up)};
}

struct CourseErrors {
    double ends = 0.0;   // of chords, radians
    double chords = 0.0; // of their middles
};

// Over the ground, as seen from where rays begin.
CourseErrors largest_errors(const terrain::Placement& placement, const SunCourse& course,
                            glm::dvec3 to_sun, const Box& ground) {
    test::Chance chance(7);
    CourseErrors errors;
    for (int i = 0; i < 60; ++i) {
        const glm::dvec3 sample(chance.between(0.0, ground.high.x),
                                chance.between(0.0, ground.high.y),
                                chance.between(0.0, ground.high.z));
        const glm::dvec3 place = placement.world_from_sample(sample);
        const std::vector<glm::dvec3> ways = course.ways_from(sample);
        const auto off = [&](glm::dvec3 way, double part) {
            const glm::dvec3 found = sample + way;
            const glm::dvec2 inside =
                glm::clamp(glm::dvec2(found), glm::dvec2(ground.low), glm::dvec2(ground.high));
            const double length = part * course.reach();
            return inside == glm::dvec2(found) ? glm::distance(placement.world_from_sample(found),
                                                               place + length * to_sun) /
                                                     length
                                               : 0.0;
        };
        for (std::size_t end = 1; end < ways.size(); ++end) {
            const auto part = [&](std::size_t at) {
                return static_cast<double>(course.bends().parts[at]);
            };
            errors.ends = std::max(errors.ends, off(ways[end], part(end)));
            const double middle = 0.5 * (part(end - 1) + part(end));
            const double lift = 0x1p-20 * ground.high.z / (middle * course.reach()); // of rays
            errors.chords =
                std::max(errors.chords, off(0.5 * (ways[end - 1] + ways[end]), middle) - lift);
        }
    }
    return errors;
}

TEST(SunCourse, FollowsTrueRays) {
    const std::array<CoursePlace, 5> places{{{},
                                             {.latitude = 0.4, .turn = 20.0},
                                             {.latitude = -60.0, .step = 0.001},
                                             {.latitude = 85.2, .step = 0.001},
                                             {.has_geoid = true}}};
    for (const CoursePlace& place : places) {
        const terrain::Placement placement = placement_at(place);
        for (const double altitude : {2.0, 10.0, 70.0}) {
            const glm::dvec3 to_sun = sun_at(130.0 * altitude, altitude);
            const Box ground = ground_up_to(3000.0);
            const auto course = SunCourse::create(placement, to_sun, {ground, ground});
            ASSERT_TRUE(course) << place.latitude << ' ' << altitude;
            const CourseErrors errors = largest_errors(placement, *course, to_sun, ground);
            EXPECT_LE(errors.ends, 0.3 * SunCourse::max_error)
                << place.latitude << ' ' << altitude << ' ' << place.has_geoid;
            EXPECT_LE(errors.chords, SunCourse::chord_error + SunCourse::max_error)
                << place.latitude << ' ' << altitude << ' ' << place.has_geoid;
        }
    }
}

TEST(SunCourse, HasAllWaysInItsBoxes) {
    const terrain::Placement placement = placement_at({.has_geoid = true});
    const Box ground = ground_up_to(3000.0);
    const auto course = SunCourse::create(placement, sun_at(200.0, 6.0), {ground, ground});
    ASSERT_TRUE(course);
    Box part;
    part.add(glm::dvec3(40.0, 60.0, 200.0));
    part.add(glm::dvec3(110.0, 200.0, 900.0));
    const std::vector<Box> ends = course->ends_from(part);
    test::Chance chance(8);
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 sample(chance.between(part.low.x, part.high.x),
                                chance.between(part.low.y, part.high.y),
                                chance.between(part.low.z, part.high.z));
        const std::vector<glm::dvec3> ways = course->ways_from(sample);
        ASSERT_EQ(ways.size(), ends.size());
        for (std::size_t end = 0; end < ways.size(); ++end) {
            const glm::dvec3 place = sample + ways[end];
            EXPECT_EQ(glm::clamp(place, ends[end].low, ends[end].high), place) << end;
        }
    }
}

// The samples of rays turn around the pole.
TEST(SunCourse, IsNoneAroundAPole) {
    const terrain::Placement placement = placement_at({.latitude = 89.9});
    const Box ground = ground_up_to(3000.0);
    EXPECT_FALSE(SunCourse::create(placement, sun_at(200.0, 6.0), {ground, ground}));
}

} // namespace
} // namespace reljef::cast
