#include "engine/terrain/field/placement.h"

#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace reljef::terrain {
namespace {

constexpr int cols = 401;
constexpr int rows = 301;

/// A geographic raster: (0,0) at a latitude and longitude, steps in degrees.
Heightfield geographic(double latitude, double longitude, double step) {
    Heightfield heightfield;
    heightfield.heights = Grid<float>(cols, rows);
    Grid<glm::dvec2> control(9, 9);
    const glm::dvec2 control_step(50.0, 37.5);
    for (int j = 0; j < 9; ++j) {
        for (int i = 0; i < 9; ++i) {
            control(i, j) = {latitude - j * control_step.y * step,
                             longitude + i * control_step.x * step};
        }
    }
    heightfield.georeference.emplace();
    heightfield.georeference->geodetic = geo::GeodeticMap(control, glm::dvec2(0.0), control_step);
    heightfield.spacing = geo::metres_per_degree(latitude - 0.5 * (rows - 1) * step) * step;
    return heightfield;
}

Heightfield nowhere(int width, int height, glm::dvec2 spacing) {
    Heightfield heightfield;
    heightfield.heights = Grid<float>(width, height);
    heightfield.spacing = spacing;
    return heightfield;
}

TEST(Placement, PlaneIsTheConventionsFormula) {
    const auto placement = Placement::create(nowhere(5, 4, {2.0, 3.0}), PlacementKind::plane, 2.5);
    ASSERT_TRUE(placement);
    EXPECT_EQ(placement->kind(), PlacementKind::plane);
    EXPECT_EQ(placement->world_from_sample({0.0, 0.0, 10.0}), glm::dvec3(-4.0, 4.5, 25.0));
    EXPECT_EQ(placement->world_from_sample({4.0, 3.0, -1.0}), glm::dvec3(4.0, -4.5, -2.5));
    EXPECT_EQ(placement->world_from_sample({2.0, 1.5, 0.0}), glm::dvec3(0.0));
    EXPECT_EQ(placement->up({1.0, 2.0, 3.0}), glm::dvec3(0.0, 0.0, 1.0));
    EXPECT_FALSE(placement->geodetic_from_world({0.0, 0.0, 0.0}));
    EXPECT_FALSE(placement->world_from_geodetic({45.0, 6.0, 0.0}));
}

// A map of the whole Earth: beyond its upper and lower edge there is no latitude.
TEST(Placement, PlaneHasNoPlaceOnEarthBesideTheMap) {
    const Heightfield earth =
        test::geographic_heightfield(Grid<float>(37, 19, 0.0F), 90.0, -180.0, 10.0);
    const auto placement = Placement::create(earth, PlacementKind::plane);
    ASSERT_TRUE(placement);
    const double edge = 9.0 * earth.spacing.y;
    const auto pole = placement->geodetic_from_world({0.0, -0.999 * edge, 5.0});
    ASSERT_TRUE(pole);
    EXPECT_NEAR(pole->latitude, -89.91, 1e-9);
    for (const double y : {-1.001 * edge, 1.001 * edge, 1e3 * edge, HUGE_VAL}) {
        EXPECT_FALSE(placement->geodetic_from_world({0.0, y, 5.0})) << y;
        EXPECT_EQ(placement->north({0.0, y, 5.0}), glm::dvec3(0.0, 1.0, 0.0));
    }
}

TEST(Placement, PlaneComesBack) {
    const auto placement =
        Placement::create(nowhere(513, 257, {0.6096, 30.0}), PlacementKind::plane, 3.0);
    ASSERT_TRUE(placement);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> places(-100.0, 700.0);
    for (int i = 0; i < 10000; ++i) {
        const glm::dvec3 sample(places(random), places(random), places(random));
        const auto again = placement->sample_from_world(placement->world_from_sample(sample));
        ASSERT_TRUE(again);
        ASSERT_LT(glm::distance(*again, sample), 1e-10);
    }
}

TEST(Placement, EllipsoidComesBackAnywhereOnEarth) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> places(-50.0, 450.0);
    std::uniform_real_distribution<double> heights(-400.0, 9000.0);
    const double step = 1.0 / 1200.0;
    for (const glm::dvec2 corner :
         {glm::dvec2(46.0, 6.0), glm::dvec2(0.1, -0.2), glm::dvec2(-16.0, 179.9),
          glm::dvec2(-16.0, -180.0), glm::dvec2(89.9, 10.0), glm::dvec2(-89.5, -120.0)}) {
        const auto placement =
            Placement::create(geographic(corner.x, corner.y, step), PlacementKind::ellipsoid, 1.5);
        ASSERT_TRUE(placement);
        EXPECT_EQ(placement->kind(), PlacementKind::ellipsoid);
        for (int i = 0; i < 2000; ++i) {
            const glm::dvec3 sample(places(random), places(random), heights(random));
            const auto again = placement->sample_from_world(placement->world_from_sample(sample));
            ASSERT_TRUE(again);
            ASSERT_LT(glm::distance(glm::dvec2(*again), glm::dvec2(sample)), 1e-6);
            ASSERT_NEAR(again->z, sample.z, 1e-7);
        }
    }
}

TEST(Placement, EllipsoidHasItsOriginAtTheCentreAndTheEarthFallsAway) {
    const auto placement =
        Placement::create(geographic(46.0, 6.0, 1.0 / 1200.0), PlacementKind::ellipsoid);
    ASSERT_TRUE(placement);
    const glm::dvec3 middle = placement->world_from_sample({200.0, 150.0, 0.0});
    EXPECT_LT(glm::length(middle), 1e-8);
    const glm::dvec3 top = placement->world_from_sample({200.0, 150.0, 4672.0});
    EXPECT_LT(glm::distance(top, glm::dvec3(0.0, 0.0, 4672.0)), 1e-7);
    const glm::dvec3 east = placement->world_from_sample({400.0, 150.0, 0.0});
    EXPECT_GT(east.x, 12000.0);
    EXPECT_NEAR(east.z, -east.x * east.x / (2.0 * 6.39e6), 0.05);
    const glm::dvec3 north = placement->world_from_sample({200.0, 0.0, 0.0});
    EXPECT_GT(north.y, 13000.0);
    EXPECT_LT(std::abs(north.x), 1e-6);
}

TEST(Placement, EllipsoidAndPlaneAgreeOverAKilometreOrTwo) {
    const Heightfield heightfield = geographic(46.0, 6.0, 1.0 / 12000.0);
    const auto flat = Placement::create(heightfield, PlacementKind::plane);
    const auto round = Placement::create(heightfield, PlacementKind::ellipsoid);
    ASSERT_TRUE(flat && round);
    for (const glm::dvec3 sample : {glm::dvec3(0.0, 0.0, 100.0), glm::dvec3(400.0, 300.0, 100.0),
                                    glm::dvec3(10.0, 290.0, 0.0)}) {
        EXPECT_LT(glm::distance(flat->world_from_sample(sample), round->world_from_sample(sample)),
                  1.0);
    }
}

TEST(Placement, UpLeadsStraightAwayFromTheEarth) {
    const auto placement =
        Placement::create(geographic(46.0, 6.0, 1.0 / 1200.0), PlacementKind::ellipsoid, 2.0);
    ASSERT_TRUE(placement);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> places(0.0, 300.0);
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec2 sample(places(random), places(random));
        const glm::dvec3 low = placement->world_from_sample(glm::dvec3(sample, 0.0));
        const glm::dvec3 high = placement->world_from_sample(glm::dvec3(sample, 1000.0));
        ASSERT_LT(glm::distance(placement->up(low), (high - low) / 2000.0), 1e-10);
        ASSERT_NEAR(glm::length(placement->up(high)), 1.0, 1e-12);
    }
}

TEST(Placement, GeodeticPositionsSpeakTrueMetresWhateverTheExaggeration) {
    const Heightfield heightfield = geographic(46.0, 6.0, 1.0 / 1200.0);
    for (const PlacementKind kind : {PlacementKind::plane, PlacementKind::ellipsoid}) {
        const auto placement = Placement::create(heightfield, kind, 4.0);
        ASSERT_TRUE(placement);
        const glm::dvec3 world = placement->world_from_sample({120.0, 60.0, 1234.5});
        const auto position = placement->geodetic_from_world(world);
        ASSERT_TRUE(position);
        EXPECT_NEAR(position->latitude, 46.0 - 0.05, 1e-11);
        EXPECT_NEAR(position->longitude, 6.1, 1e-11);
        EXPECT_NEAR(position->height, 1234.5, 1e-7);
        const auto again = placement->world_from_geodetic(*position);
        ASSERT_TRUE(again);
        EXPECT_LT(glm::distance(*again, world), 1e-6);
    }
}

TEST(Placement, EllipsoidNeedsAPlaceOnEarth) {
    const auto placement = Placement::create(nowhere(5, 4, {1.0, 1.0}), PlacementKind::ellipsoid);
    ASSERT_FALSE(placement);
    EXPECT_NE(placement.error().message.find("placement ellipsoid"), std::string::npos);
}

TEST(Placement, ExaggerationIsFiniteAndAboveZero) {
    for (const double wrong : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
        const auto placement =
            Placement::create(nowhere(5, 4, {1.0, 1.0}), PlacementKind::plane, wrong);
        ASSERT_FALSE(placement);
        EXPECT_NE(placement.error().message.find("exaggeration"), std::string::npos);
    }
}

} // namespace
} // namespace reljef::terrain
