#include "engine/scene/motion/walker.h"

#include <cmath>
#include <memory>
#include <random>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "engine/scene/motion/camera_gestures.h"
#include "engine/scene/motion/free_flight.h"
#include "tests/support/release_only.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::scene {
namespace {

TerrainNode ground_of(Grid<float> heights, glm::dvec2 spacing = {1.0, 1.0}) {
    auto surface = TerrainSurface::create(std::make_shared<const terrain::Terrain>(
        terrain::Terrain{"made", test::plane_heightfield(std::move(heights), spacing), {}, {}}));
    EXPECT_TRUE(surface);
    return {std::make_shared<const TerrainSurface>(std::move(*surface)), {}};
}

// 40 m wide; z rises by `slope` to the east.
TerrainNode slope_node(double slope) {
    return ground_of(test::made_heights(41, 41, [&](int col, int) { return slope * (col - 20); }));
}

// Level, with a wall of 10 m between x = 4.5 and 5.5.
TerrainNode wall_node() {
    return ground_of(
        test::made_heights(80, 80, [](int col, int) { return col < 45 ? 0.0 : 10.0; }));
}

double lift_at(const TerrainNode& node, const WalkingBody& body, const Walker& walker) {
    return ground_contact(node, body.shape, walker.center)->lift;
}

Walker walk(const TerrainNode& node, const WalkingBody& body, Walker walker, glm::dvec3 speed,
            double seconds) {
    constexpr double step = 1.0 / 60.0;
    for (double time = 0.0; time < seconds; time += step) {
        walker = walked(node, body, walker, step * speed, step);
    }
    return walker;
}

TEST(Walker, FallsAsGravityPullsIt) {
    const TerrainNode node = slope_node(0.0);
    const WalkingBody body;
    Walker walker{{0.0, 0.0, 100.0}};
    walker = walk(node, body, walker, {}, 2.0);
    EXPECT_FALSE(walker.on_ground);
    EXPECT_NEAR(walker.center.z, 100.0 - 0.5 * 9.81 * 4.0, 0.5);
    EXPECT_NEAR(walker.velocity.z, -2.0 * 9.81, 0.3);
    walker = walk(node, body, walker, {}, 8.0);
    EXPECT_TRUE(walker.on_ground);
    EXPECT_EQ(walker.velocity, glm::dvec3(0.0));
    EXPECT_NEAR(walker.center.z, 0.9, 1e-9);
    EXPECT_EQ(glm::dvec2(walker.center), glm::dvec2(0.0));
}

TEST(Walker, JumpsAndComesBack) {
    const TerrainNode node = slope_node(0.0);
    Walker walker{{0.0, 0.0, 0.9}};
    walker = walked(node, {}, walker, {}, 0.02);
    ASSERT_TRUE(walker.on_ground);
    walker.velocity = {2.0, 0.0, 5.0};
    walker = walked(node, {}, walker, {}, 0.1);
    EXPECT_FALSE(walker.on_ground);
    EXPECT_NEAR(walker.center.x, 0.2, 1e-9);
    EXPECT_NEAR(walker.center.z, 0.9 + 0.5 - 0.5 * 9.81 * 0.01, 1e-9);
    walker = walk(node, {}, walker, {1.0, 0.0, 0.0}, 1.5);
    EXPECT_TRUE(walker.on_ground);
}

TEST(Walker, StandsOnGentleSlopesAndSlidesDownSteepOnes) {
    const WalkingBody body;
    Walker gentle{{0.0, 0.0, 2.0}};
    gentle = walk(slope_node(0.9), body, gentle, {}, 2.0);
    EXPECT_TRUE(gentle.on_ground);
    EXPECT_EQ(gentle.center.x, 0.0);
    Walker steep{{0.0, 0.0, std::hypot(0.9, 1.5 * 0.4)}};
    steep = walk(slope_node(1.5), body, steep, {}, 1.5);
    EXPECT_FALSE(steep.on_ground);
    // Without friction: g · sin · cos of the slope.
    EXPECT_NEAR(steep.center.x, -0.5 * 9.81 * 1.5 / (1.0 + 1.5 * 1.5) * 1.5 * 1.5, 0.15);
    EXPECT_NEAR(lift_at(slope_node(1.5), body, steep), 0.0, 0.1);
}

TEST(Walker, KeepsToTheGroundUphillAndDownhill) {
    const TerrainNode node = slope_node(0.8);
    const WalkingBody body;
    Walker walker = walk(node, body, {{-10.0, 0.0, 0.0}}, {}, 3.0);
    for (const double speed : {3.0, -3.0}) {
        const double from = walker.center.x;
        for (int i = 0; i < 120; ++i) {
            walker = walked(node, body, walker, {speed / 60.0, 0.0, 0.0}, 1.0 / 60.0);
            ASSERT_TRUE(walker.on_ground) << i;
            ASSERT_NEAR(lift_at(node, body, walker), 0.0, 1e-9);
        }
        EXPECT_GT((walker.center.x - from) * speed, 0.0);
    }
}

TEST(Walker, SlidesAlongAWall) {
    const TerrainNode node = wall_node();
    const WalkingBody body;
    Walker walker = walk(node, body, {{0.0, -20.0, 1.0}}, {}, 1.0);
    walker = walk(node, body, walker, {2.0, 2.0, 0.0}, 8.0);
    EXPECT_LT(walker.center.x, 5.0) << "in front of the wall";
    EXPECT_GT(walker.center.x, 3.5);
    EXPECT_NEAR(walker.center.y, -20.0 + 16.0, 0.3) << "along it";
    EXPECT_LT(walker.center.z, 1.5) << "at its foot";
}

TEST(Walker, WithoutGravityFliesAndIsStopped) {
    const TerrainNode node = wall_node();
    const WalkingBody body{.shape = {0.5, 0.5}, .gravity = 0.0};
    Walker walker{{0.0, 0.0, 5.0}};
    walker = walked(node, body, walker, {20.0, 0.0, 0.0}, 1.0);
    EXPECT_FALSE(walker.on_ground);
    EXPECT_GE(walker.center.z, 5.0);
    EXPECT_LE(lift_at(node, body, walker), 1e-9);
    walker = walked(node, body, {{0.0, 0.0, 5.0}}, {0.0, 3.0, 4.0}, 1.0);
    EXPECT_LE(glm::distance(walker.center, {0.0, 3.0, 9.0}), 1e-12);
}

// A thousand ways by chance over a city of towers.
TEST(Walker, NeverEndsInTheGround) {
    const TerrainNode node = ground_of(test::random_heights(61, 61, 0.0F, 30.0F, 8));
    std::mt19937 random(9);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (const Ellipsoid shape : {Ellipsoid{0.4, 0.9}, {2.0, 1.0}}) {
        const WalkingBody body{.shape = shape};
        Walker walker{{0.0, 0.0, 40.0}};
        for (int i = 0; i < test::rounds(1000, 250); ++i) {
            const glm::dvec3 way =
                std::pow(4.0, any(random)) * glm::dvec3(any(random), any(random), any(random));
            const glm::dvec2 to = glm::dvec2(walker.center + way);
            if (std::abs(to.x) > 25.0 || std::abs(to.y) > 25.0) {
                continue;
            }
            walker = walked(node, body, walker, way, 0.02);
            ASSERT_TRUE(ground_contact(node, shape, walker.center)) << i;
            ASSERT_LE(lift_at(node, body, walker), 1e-9) << i;
        }
    }
}

TEST(Walker, ThatBeginsInTheGroundIsLifted) {
    const TerrainNode node = slope_node(0.5);
    const Walker walker = walked(node, {}, {{0.0, 0.0, -500.0}}, {}, 0.0);
    EXPECT_LE(lift_at(node, {}, walker), 1e-9);
}

TEST(Walker, BesideTheTerrainNothingStopsIt) {
    const Walker walker = walked(slope_node(0.0), {}, {{100.0, 0.0, 5.0}}, {1.0, 0.0, 0.0}, 2.0);
    EXPECT_NEAR(walker.center.x, 101.0, 1e-9);
    EXPECT_NEAR(walker.center.z, 5.0 - 0.5 * 9.81 * 4.0, 1e-9);
}

TEST(Walker, WhatIsNotFiniteCountsAsNothing) {
    const TerrainNode node = slope_node(0.0);
    const Walker before{{0.0, 0.0, 0.9}, {}, true};
    for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        EXPECT_EQ(walked(node, {}, before, {bad, 0.0, 0.0}, 0.0).center, before.center);
        EXPECT_EQ(walked(node, {}, before, {}, bad).center, before.center);
        const Walker lost{{bad, 0.0, 0.0}};
        EXPECT_FALSE(std::isfinite(walked(node, {}, lost, {1.0, 0.0, 0.0}, 1.0).center.x));
        const Walker falling{{0.0, 0.0, 0.9}, {0.0, bad, 0.0}};
        EXPECT_TRUE(std::isfinite(walked(node, {}, falling, {}, 0.1).center.z)) << bad;
    }
    EXPECT_EQ(walked(node, {}, before, {}, -1.0), before);
    EXPECT_TRUE(std::isfinite(walked(node, {}, {{0.0, 0.0, 1e6}}, {}, 1e9).center.z));
}

// A camera that walks: free flight says where to, and goes along.
TEST(Walker, CarriesACamera) {
    const TerrainNode node = slope_node(0.5);
    FreeFlight flight(camera_from_angles({0.0, 0.0, 0.9}, 90.0, -10.0), {});
    flight.change_speed(-17.0); // from 100 to 2.3 metres a second
    Walker walker{flight.camera().eye};
    flight.receive(KeyEvent{Key::w, true});
    for (int i = 0; i < 60; ++i) {
        flight.advance(1.0 / 60.0);
        Camera camera = flight.camera();
        walker = walked(node, {}, walker, camera.eye - walker.center, 1.0 / 60.0);
        camera.target += walker.center - camera.eye;
        camera.eye = walker.center;
        flight.set_camera(camera);
    }
    EXPECT_TRUE(walker.on_ground);
    EXPECT_GT(flight.camera().eye.x, 1.0);
    EXPECT_NEAR(lift_at(node, {}, {flight.camera().eye}), 0.0, 1e-6);
    const ViewAngles angles = angles_of(flight.camera(), GestureWorld{});
    EXPECT_NEAR(angles.heading, 90.0, 1e-6);
    EXPECT_NEAR(angles.pitch, -10.0, 1e-6);
}

TEST(Walker, DependsOnItsArgumentsAlone) {
    const TerrainNode node = ground_of(test::random_heights(31, 31, 0.0F, 5.0F, 10));
    const Walker before{{1.0, 2.0, 4.0}, {0.0, 0.0, -3.0}, false};
    const Walker once = walked(node, {}, before, {0.3, -0.2, 0.0}, 0.05);
    (void)walked(node, {}, {{5.0, 5.0, 9.0}}, {1.0, 1.0, 0.0}, 0.5);
    EXPECT_EQ(walked(node, {}, before, {0.3, -0.2, 0.0}, 0.05), once);
}

} // namespace
} // namespace reljef::scene
