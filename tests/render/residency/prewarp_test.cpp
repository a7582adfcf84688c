#include "engine/render/residency/prewarp.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/terrain/field/heightfield.h"
#include "engine/terrain/field/min_max_pyramid.h"
#include "engine/terrain/field/ray_cast.h"
#include "tests/render/made_scene.h"
#include "tests/terrain/chance.h"

namespace reljef::render {
namespace {

// Where the line from the eye through a point meets the plane of height 0, by similar triangles.
glm::dvec2 projected(glm::dvec3 eye, glm::dvec3 point) {
    const double t = eye.z / (eye.z - point.z);
    return glm::dvec2(eye + t * (point - eye));
}

TEST(Prewarp, TheFormulaIsTheProjectionOntoThePlane) {
    test::Chance chance(3);
    for (int i = 0; i < 5000; ++i) {
        const glm::dvec3 eye{chance.between(-300.0, 300.0), chance.between(-300.0, 300.0),
                             chance.between(1.0, 100.0)};
        const glm::dvec2 place{chance.between(0.0, 100.0), chance.between(0.0, 100.0)};
        const double height = chance.between(-1.0, 0.99);
        const auto seen = Warp(glm::dvec4(eye, 1.0)).at(place, height);
        ASSERT_TRUE(seen);
        const glm::dvec2 right = projected(eye, {place, height});
        EXPECT_LT(glm::distance(*seen, right), 1e-9 * (1.0 + glm::length(right)));
        // From so far away all of it is seen along one direction, to a thousandth of a sample.
        const auto far_off = Warp(glm::dvec4(glm::normalize(eye), 0.0)).at(place, height);
        const auto farther = Warp(glm::dvec4(1e9 * glm::normalize(eye), 1.0)).at(place, height);
        EXPECT_LT(glm::distance(*far_off, *farther), 1e-3);
    }
}

TEST(Prewarp, WhatIsNotBelowTheEyeIsNotSeen) {
    EXPECT_FALSE(Warp({5.0, 5.0, 1.0, 1.0}).at({3.0, 3.0}, 1.0));
    EXPECT_FALSE(Warp({5.0, 5.0, 1.0, 1.0}).at({3.0, 3.0}, 2.0));
    EXPECT_FALSE(Warp({5.0, 5.0, -1.0, 1.0}).at({3.0, 3.0}, -2.0));
    EXPECT_FALSE(Warp({5.0, 5.0, 0.0, 0.0}).at({3.0, 3.0}, 0.0));
}

TEST(Prewarp, ALevelSurfaceInThePlaneStaysWhereItIs) {
    const Grid<float> level(40, 30, 0.0F);
    const Grid<glm::vec2> places = prewarped(level.view(), Warp({7.0, -50.0, 9.0, 1.0}));
    for (int row = 0; row < 30; ++row) {
        for (int col = 0; col < 40; ++col) {
            EXPECT_EQ(places(col, row), glm::vec2(col, row));
        }
    }
}

Grid<float> bumps(int cols, int rows, double height) {
    return test::hills(cols, rows, height);
}

// Every sample of the plane shows a place whose own projection lies within half a sample of it,
// and it is the place that the ray meets first.
TEST(Prewarp, ShowsWhatIsProjectedThere) {
    const Grid<float> heights = bumps(129, 97, 6.0);
    const terrain::MinMaxPyramid pyramid(heights.view());
    const Warp near({20.0, 150.0, 90.0, 1.0});
    const glm::dvec3 eye{20.0, 150.0, 90.0};
    const Grid<glm::vec2> places = prewarped(heights.view(), near);
    int seen = 0;
    int right = 0;
    for (int row = 0; row < places.rows(); ++row) {
        for (int col = 0; col < places.cols(); ++col) {
            const Ray ray{eye, glm::dvec3(col, row, 0.0) - eye};
            const auto hit = terrain::first_hit(heights.view(), pyramid, ray, {0.0, 10.0});
            if (!hit) {
                continue;
            }
            ++seen;
            const glm::dvec2 place(places(col, row));
            const auto again =
                place.x < 0.0 ? std::nullopt
                              : near.at(place, terrain::bilinear_height(heights.view(), place));
            const bool projects = again && glm::distance(*again, glm::dvec2(col, row)) <= 0.5;
            right += projects && glm::distance(place, glm::dvec2(hit->sample)) <= 1.0 ? 1 : 0;
        }
    }
    EXPECT_GT(seen, 11000);
    EXPECT_GE(right, 0.999 * seen);
}

// Where hills hide others the nearer one is shown, but for what the first pass loses: of two places
// that come to lie on one column of a row it keeps one, whatever rows they go to.
TEST(Prewarp, TheNearerHillHidesTheFarther) {
    const Grid<float> heights = bumps(129, 97, 12.0);
    const terrain::MinMaxPyramid pyramid(heights.view());
    for (const glm::dvec4 eye :
         {glm::dvec4(64.0, 260.0, 60.0, 1.0), glm::dvec4(-150.0, 40.0, 55.0, 1.0),
          glm::dvec4(1.0, 0.0, 0.35, 0.0)}) {
        const Grid<glm::vec2> places = prewarped(heights.view(), Warp(eye));
        int seen = 0;
        int right = 0;
        for (int row = 0; row < places.rows(); ++row) {
            for (int col = 0; col < places.cols(); ++col) {
                const glm::dvec3 target(col, row, 0.0);
                const glm::dvec3 from =
                    eye.w > 0.0 ? glm::dvec3(eye) : target + 1000.0 * glm::dvec3(eye);
                const auto hit =
                    terrain::first_hit(heights.view(), pyramid, {from, target - from}, {0.0, 10.0});
                if (hit) {
                    ++seen;
                    const glm::dvec2 place(places(col, row));
                    right += glm::distance(place, glm::dvec2(hit->sample)) <= 1.0 ? 1 : 0;
                }
            }
        }
        EXPECT_GE(right, 0.9 * seen) << eye.x << ": " << right << " of " << seen;
    }
}

TEST(Prewarp, IsFiniteForAnyEye) {
    test::Chance chance(8);
    const Grid<float> heights = test::random_heights(17, 23, -1.0F, 1.0F, 4);
    for (int i = 0; i < 500; ++i) {
        const double size = std::pow(10.0, chance.between(-6.0, 12.0));
        const glm::dvec4 eye{chance.between(-size, size), chance.between(-size, size),
                             chance.between(-size, size), chance.one_in(2) ? 1.0 : 0.0};
        const Grid<glm::vec2> places = prewarped(heights.view(), Warp(eye));
        for (const glm::vec2 place : places.samples()) {
            const bool inside =
                place.x >= 0.0F && place.x <= 16.0F && place.y >= 0.0F && place.y <= 22.0F;
            ASSERT_TRUE(inside || place == glm::vec2(-1.0F));
        }
    }
}

} // namespace
} // namespace reljef::render
