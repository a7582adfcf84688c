#include "engine/scene/streaming/certain_sun.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/terrain/field/placement.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::scene {
namespace {

// Whether a ray is below the surface somewhere: in small steps.
bool is_hidden(GridView<const float> heights, glm::dvec3 place, glm::dvec3 to_sun) {
    const double step = 0.01 / std::max(std::abs(to_sun.x), std::abs(to_sun.y));
    const glm::dvec2 last(heights.cols() - 1, heights.rows() - 1);
    for (double t = step;; t += step) {
        const glm::dvec3 at = place + t * to_sun;
        if (at.x < 0.0 || at.y < 0.0 || at.x > last.x || at.y > last.y) {
            return false;
        }
        if (terrain::bilinear_height(heights, glm::dvec2(at)) > at.z) {
            return true;
        }
    }
}

constexpr double lift = 0.01;

SunRays rays_to(glm::dvec3 to_sun, double max_variation = 1e9) {
    return {.to_sun = to_sun, .max_lift = lift, .max_variation = max_variation};
}

struct Found {
    int lit = 0;
    int dark = 0;
    int wrong = 0;
};

Found check_places(const Grid<float>& heights, glm::dvec3 to_sun, test::Chance& chance) {
    const Grid<CertainSun> known = certain_sun(heights.view(), rays_to(to_sun));
    Found found;
    for (int row = 0; row < known.rows(); ++row) {
        for (int col = 0; col < known.cols(); ++col) {
            if (known(col, row) == CertainSun::unknown) {
                continue;
            }
            const bool is_lit = known(col, row) == CertainSun::lit;
            const glm::dvec2 place(col + chance.between(0.0, 1.0), row + chance.between(0.0, 1.0));
            const double above = is_lit ? 1e-9 : lift;
            const glm::dvec3 start(place, terrain::bilinear_height(heights.view(), place) + above);
            found.wrong += is_hidden(heights.view(), start, to_sun) == is_lit ? 1 : 0;
            ++(is_lit ? found.lit : found.dark);
        }
    }
    return found;
}

TEST(CertainSun, IsRightWhereverItIsCertain) {
    test::Chance chance(41);
    Found all;
    for (unsigned i = 0; i < 40; ++i) {
        const double scale = chance.between(0.5, 6.0);
        const double width = chance.between(3.0, 15.0);
        const Grid<float> noise = test::random_heights(48, 37, -0.3F, 0.3F, 100U + i);
        const Grid<float> heights = test::made_heights(48, 37, [&](int col, int row) {
            return scale * std::sin(col / width) * std::cos(row / width) + noise(col, row);
        });
        const double azimuth = chance.between(0.0, 6.283);
        const glm::dvec3 to_sun(std::sin(azimuth), std::cos(azimuth), chance.between(0.05, 0.8));
        const Found found = check_places(heights, to_sun, chance);
        EXPECT_EQ(found.wrong, 0) << i;
        all.lit += found.lit;
        all.dark += found.dark;
    }
    EXPECT_GT(all.lit, 15'000) << "of 70,000";
    EXPECT_GT(all.dark, 2'000);
}

TEST(CertainSun, IsCertainOfAWallsShadow) {
    // A wall of 10 m, and a sun in the east that rises by half a metre a sample: 20 samples.
    const Grid<float> heights = test::made_heights(
        60, 30, [](int col, int /*row*/) { return col == 40 || col == 41 ? 10.0 : 0.0; });
    const auto known = certain_sun(heights.view(), rays_to({1.0, 0.0, 0.5}));
    for (const int row : {2, 15, 26}) {
        EXPECT_EQ(known(10, row), CertainSun::lit);
        EXPECT_EQ(known(25, row), CertainSun::dark);
        EXPECT_EQ(known(36, row), CertainSun::dark);
        EXPECT_EQ(known(50, row), CertainSun::lit);
        EXPECT_NE(known(39, row), CertainSun::lit);
    }
    const auto turned = certain_sun(heights.view(), rays_to({-1.0, 0.0, 0.5}));
    EXPECT_EQ(turned(50, 15), CertainSun::dark);
    EXPECT_EQ(turned(25, 15), CertainSun::lit);
}

TEST(CertainSun, KnowsNothingOfCellsWhoseRaysMayBeginBelowTheSurface) {
    const Grid<float> heights = test::made_heights(
        60, 30, [](int col, int /*row*/) { return col == 40 || col == 41 ? 10.0 : 0.0; });
    const auto known = certain_sun(heights.view(), rays_to({1.0, 0.0, 0.5}, 9.0));
    for (int col = 38; col <= 42; ++col) {
        EXPECT_EQ(known(col, 15), CertainSun::unknown);
    }
    EXPECT_EQ(known(25, 15), CertainSun::dark);
    EXPECT_EQ(known(43, 15), CertainSun::lit);
}

TEST(CertainSun, FlatGroundIsLit) {
    const Grid<float> heights(20, 30, 7.0F);
    for (const glm::dvec3 to_sun : {glm::dvec3(0.3, -0.9, 0.01), glm::dvec3(0.0, 0.0, 1.0)}) {
        const auto known = certain_sun(heights.view(), rays_to(to_sun));
        for (const CertainSun cell : known.samples()) {
            EXPECT_EQ(cell, CertainSun::lit);
        }
    }
}

TEST(CertainSun, HasNoSunBelowTheHorizonOrOnTheEllipsoid) {
    const auto heightfield = test::plane_heightfield(Grid<float>(5, 5, 0.0F), {2.0, 4.0});
    const auto placement =
        terrain::Placement::create(heightfield, terrain::PlacementKind::plane, 2.0);
    TerrainLight light;
    light.sun.azimuth = 90.0;
    light.sun.altitude = 45.0;
    const auto to_sun = sun_in_samples(placement.value(), light);
    ASSERT_TRUE(to_sun);
    EXPECT_NEAR(to_sun->x / to_sun->z, 1.0, 1e-12); // half a sample, half a metre
    EXPECT_NEAR(to_sun->y, 0.0, 1e-12);
    light.sun.altitude = -3.0;
    EXPECT_FALSE(sun_in_samples(placement.value(), light));
}

} // namespace
} // namespace reljef::scene
