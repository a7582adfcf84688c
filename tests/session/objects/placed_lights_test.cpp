#include "engine/session/objects/placed_lights.h"

#include <array>
#include <cstddef>
#include <random>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/color.h"
#include "engine/session/objects/ground_place.h"
#include "tests/session/objects/made_ground.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::session {
namespace {

using testing::HasSubstr;

// z = 3 x + 100 over 20 m.
terrain::Heightfield ramp() {
    return test::plane_heightfield(test::made_heights(
        21, 21, [](int col, int) { return 100.0F + 3.0F * static_cast<float>(col - 10); }));
}

io::PointLightDescription light_at(glm::dvec2 at) {
    return {.at = at, .height = 7.0, .intensity = 9.0, .range = 12.0, .color = {255, 128, 0, 255}};
}

TEST(PlacedLights, StandAboveTheGroundAlsoOfAnotherSurface) {
    scene::Scene scene;
    const auto placed =
        add_point_lights(scene, test::ground_of(ramp()), {light_at({1.25, 0.5})}, {});
    ASSERT_TRUE(placed) << placed.error().message;
    const auto lights = scene.point_lights();
    ASSERT_EQ(lights.size(), 1U);
    EXPECT_LT(glm::distance(lights[0].place, glm::dvec3(1.25, 0.5, 110.75)), 1e-6);
    EXPECT_EQ(lights[0].light.intensity, 9.0F);
    EXPECT_EQ(lights[0].light.range, 12.0F);
    EXPECT_EQ(lights[0].light.color, linear_from_rgba8({255, 128, 0, 255}));
    stand_on(test::ground_of(ramp(), 2.0), *placed);
    EXPECT_LT(glm::distance(scene.point_lights()[0].place, glm::dvec3(1.25, 0.5, 214.5)), 1e-6)
        << "the ground is twice as high, the lamp as high above it";
}

TEST(PlacedLights, StandAlongTheVerticalAtLatitudeAndLongitude) {
    const scene::TerrainSurface surface = test::ground_of(test::geographic_heightfield(
        Grid<float>(201, 201, 1000.0F), 46.0, 7.0, 0.01)); // to 44° north, 9° east
    scene::Scene scene;
    const auto placed = add_point_lights(scene, surface, {light_at({45.25, 8.5})}, {});
    ASSERT_TRUE(placed) << placed.error().message;
    const auto expected = surface.placement().world_from_geodetic({45.25, 8.5, 1007.0});
    EXPECT_LT(glm::distance(scene.point_lights()[0].place, expected.value()), 0.01);
}

// Positions on Earth round: a place of the border may be a little outside the samples.
TEST(PlacedLights, MayStandOnTheBorderOfTheEllipsoid) {
    const scene::TerrainSurface surface = test::ground_of(
        test::geographic_heightfield(Grid<float>(201, 201, 1000.0F), 46.0, 7.0, 0.01));
    std::mt19937 random(5);
    std::uniform_real_distribution<double> along(0.0, 2.0);
    for (int i = 0; i < 2000; ++i) {
        const double part = along(random);
        const std::array<glm::dvec2, 4> places{
            {{44.0 + part, 7.0}, {44.0 + part, 9.0}, {44.0, 7.0 + part}, {46.0, 7.0 + part}}};
        const glm::dvec2 place = places[static_cast<std::size_t>(i % 4)];
        const auto ground = ground_at(surface, {"border", place});
        ASSERT_TRUE(ground) << ground.error().message;
    }
    for (const glm::dvec2 outside : {glm::dvec2(45.0, 6.999999), glm::dvec2(46.000001, 8.0)}) {
        EXPECT_FALSE(ground_at(surface, {"outside", outside}));
    }
}

TEST(PlacedLights, TakeTheSourcesHeight) {
    scene::Scene scene;
    const auto placed = add_point_lights(scene, test::ground_of(ramp()), {light_at({0.0, 0.0})},
                                         [](glm::dvec2) { return 500.0; });
    ASSERT_TRUE(placed) << placed.error().message;
    EXPECT_NEAR(scene.point_lights()[0].place.z, 507.0, 1e-6);
    const auto refused = add_point_lights(scene, test::ground_of(ramp()), {light_at({0.0, 0.0})},
                                          [](glm::dvec2) { return std::optional<double>(); });
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, HasSubstr("point light 1: at 0,0 no height found"));
}

TEST(PlacedLights, AreRefusedBesideTheTerrain) {
    scene::Scene scene;
    const auto refused = add_point_lights(scene, test::ground_of(ramp()),
                                          {light_at({0.0, 0.0}), light_at({11.0, 0.0})}, {});
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message,
                HasSubstr("point light 2: at 11,0 a place outside the terrain found, one on made"));
}

} // namespace
} // namespace reljef::session
