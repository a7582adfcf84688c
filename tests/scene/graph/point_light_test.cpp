#include "engine/scene/graph/point_light.h"

#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/scene/graph/scene.h"
#include "engine/scene/motion/node_motions.h"

namespace reljef::scene {
namespace {

constexpr glm::vec3 up_normal{0.0F, 0.0F, 1.0F};
constexpr PlacedPointLight lamp{{.color = {1.0F, 0.5F, 0.25F}, .intensity = 36.0F, .range = 40.0F},
                                {0.0, 0.0, 6.0}};

double window(double distance) {
    const double part = std::pow(distance / lamp.light.range, 4);
    return (1.0 - part) * (1.0 - part);
}

// A whole metre below: 36 / 6² = 1, times the window.
TEST(PointLight, FallsWithTheSquareOfTheDistanceAndTheCosine) {
    for (const double x : {0.0, 1.5, 8.0, 30.0}) {
        const double square = x * x + 36.0;
        const double cosine = 6.0 / std::sqrt(square);
        const double expected = 36.0 * cosine / square * window(std::sqrt(square));
        const glm::vec3 found = radiance_from(lamp, {x, 0.0, 0.0}, up_normal);
        EXPECT_NEAR(found.r, expected, 1e-6 * expected) << x;
        EXPECT_NEAR(found.g, 0.5 * expected, 1e-6 * expected) << x;
        EXPECT_NEAR(found.b, 0.25 * expected, 1e-6 * expected) << x;
    }
}

TEST(PointLight, GivesNothingAtItsRangeAndBehind) {
    const double at_range = std::sqrt(40.0 * 40.0 - 36.0);
    EXPECT_GT(radiance_from(lamp, {at_range - 0.1, 0.0, 0.0}, up_normal).r, 0.0F);
    EXPECT_EQ(radiance_from(lamp, {at_range + 1e-9, 0.0, 0.0}, up_normal), glm::vec3(0.0F));
    EXPECT_EQ(radiance_from(lamp, {1e9, 0.0, 0.0}, up_normal), glm::vec3(0.0F));
    EXPECT_EQ(radiance_from(lamp, {0.0, 0.0, 7.0}, up_normal), glm::vec3(0.0F)) << "turned away";
}

TEST(PointLight, GivesNothingWithoutARange) {
    const PlacedPointLight none{{.range = 0.0F}, {0.0, 0.0, 6.0}};
    EXPECT_EQ(radiance_from(none, {0.0, 0.0, 5.999}, up_normal), glm::vec3(0.0F));
}

TEST(PointLight, IsFiniteAtItsPlace) {
    const float nearest = 36.0F / (nearest_point_light * nearest_point_light);
    EXPECT_EQ(radiance_from(lamp, lamp.place, up_normal), glm::vec3(0.0F)) << "without direction";
    const glm::dvec3 below = lamp.place - glm::dvec3(0.0, 0.0, 1e-3);
    EXPECT_LE(radiance_from(lamp, below, up_normal).r, nearest);
    EXPECT_GT(radiance_from(lamp, below, up_normal).r, 0.0F);
}

TEST(PointLight, SeveralAddUp) {
    const std::array lights{lamp, lamp, lamp};
    const glm::dvec3 place(3.0, 2.0, 0.0);
    EXPECT_LT(glm::distance(radiance_from(lights, place, up_normal),
                            3.0F * radiance_from(lamp, place, up_normal)),
              1e-5F);
}

TEST(PointLight, IsWhereItsNodeIs) {
    Scene scene;
    Node& street = scene.root().add("street");
    street.set_position({10.0, 0.0, 0.0});
    Node& node = street.add("lamp", PointLight{.intensity = 9.0F});
    node.set_position({0.0, 5.0, 2.0});
    scene.add_point_light({.intensity = 4.0F}, {1.0, 2.0, 3.0});
    const auto lights = scene.point_lights();
    ASSERT_EQ(lights.size(), 2U);
    EXPECT_EQ(lights[0].light.intensity, 9.0F);
    EXPECT_EQ(lights[0].place, glm::dvec3(10.0, 5.0, 2.0));
    EXPECT_EQ(lights[1].place, glm::dvec3(1.0, 2.0, 3.0));
    street.set_visible(false);
    EXPECT_EQ(scene.point_lights().size(), 1U);
    EXPECT_FALSE(scene.sun()) << "a lamp is no sun";
}

TEST(PointLight, ShinesAlikeEverywhereIfItsRaysAreParallel) {
    const Light light{
        .azimuth = 90.0, .altitude = 30.0, .color = {2.0F, 1.0F, 0.5F}, .ambient = glm::vec3(9.0F)};
    const PlacedPointLight placed = as_point_light(light);
    for (const double metres : {0.0, -50.0, 1e4, 1e7}) {
        for (const glm::dvec3 axis : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)}) {
            const glm::vec3 level = radiance_from(placed, metres * axis, up_normal);
            EXPECT_LT(glm::distance(level, 0.5F * light.color), 3e-4F) << metres; // 1e-4 radians
            const glm::vec3 facing =
                radiance_from(placed, metres * axis, glm::vec3(to_light(light)));
            EXPECT_LT(glm::distance(facing, light.color), 3e-4F) << metres;
        }
    }
    EXPECT_EQ(radiance_from(placed, {}, -up_normal), glm::vec3(0.0F));
}

TEST(PointLight, IsEveryLightButTheFirstVisibleOne) {
    Scene scene;
    Node& first = scene.add_light({.azimuth = 10.0});
    Node& second = scene.add_light({.azimuth = 20.0, .altitude = 0.0});
    scene.add_point_light({.intensity = 4.0F});
    EXPECT_EQ(scene.sun()->azimuth, 10.0);
    const auto lights = scene.point_lights();
    ASSERT_EQ(lights.size(), 2U);
    EXPECT_EQ(lights[0], as_point_light({.azimuth = 20.0, .altitude = 0.0}));
    EXPECT_EQ(lights[1].light.intensity, 4.0F);
    first.set_visible(false);
    EXPECT_EQ(scene.sun()->azimuth, 20.0);
    EXPECT_EQ(scene.point_lights().size(), 1U) << "it is the sun now";
    second.set_visible(false);
    EXPECT_FALSE(scene.sun());
}

TEST(PointLight, MovesWithItsAnimators) {
    Scene scene;
    Node& node = scene.add_point_light();
    node.add_animator(
        animator(FlyCircle{.center = {0.0, 0.0, 8.0}, .radius = 5.0, .seconds = 4.0}));
    scene.root().animate(1.0);
    EXPECT_LT(glm::distance(scene.point_lights().front().place, glm::dvec3(0.0, 5.0, 8.0)), 1e-9);
    scene.root().animate(2.0);
    EXPECT_LT(glm::distance(scene.point_lights().front().place, glm::dvec3(-5.0, 0.0, 8.0)), 1e-9);
}

} // namespace
} // namespace reljef::scene
