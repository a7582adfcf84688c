#include "bench/runner/moving_view.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace reljef::bench {
namespace {

TEST(MovingView, MovesByTheSameStepInEachFrameAndComesBack) {
    scene::Camera camera;
    camera.eye = {10.0, -800.0, 200.0};
    camera.target = {300.0, 0.0, 0.0};
    Box bounds;
    bounds.add(glm::dvec3(-500.0, -250.0, 0.0));
    bounds.add(glm::dvec3(500.0, 250.0, 100.0));
    const MovingView view(camera, bounds, [](double, double) { return 0.0; });
    EXPECT_EQ(view.at(0).eye, camera.eye);
    EXPECT_EQ(view.at(40).eye, camera.eye);
    const glm::dvec3 right = scene::view_axes(camera).right;
    double farthest = 0.0;
    for (int frame = 0; frame < 100; ++frame) {
        const scene::Camera now = view.at(frame);
        const scene::Camera next = view.at(frame + 1);
        EXPECT_NEAR(glm::distance(next.eye, now.eye), 2.0, 1e-9) << frame;
        EXPECT_NEAR(glm::length((now.target - now.eye) - (camera.target - camera.eye)), 0.0, 1e-9);
        const double way = glm::dot(now.eye - camera.eye, right);
        EXPECT_NEAR(glm::length(now.eye - camera.eye), std::abs(way), 1e-9);
        farthest = std::max(farthest, std::abs(way));
    }
    EXPECT_NEAR(farthest, 20.0, 1e-9);
}

TEST(MovingView, RisesWithTheGroundAndNeverEntersIt) {
    scene::Camera camera;
    camera.eye = {0.0, 0.0, 12.0};
    camera.target = {0.0, 100.0, 10.0};
    Box bounds;
    bounds.add(glm::dvec3(-500.0, -500.0, 0.0));
    bounds.add(glm::dvec3(500.0, 500.0, 500.0));
    const auto ground = [](double x, double /*y*/) { return 10.0 + 20.0 * std::abs(x); };
    const MovingView view(camera, bounds, ground);
    for (int frame = 0; frame < 50; ++frame) {
        const scene::Camera now = view.at(frame);
        EXPECT_NEAR(now.eye.z, ground(now.eye.x, 0.0) + 2.0, 1e-9) << frame;
        EXPECT_NEAR(now.target.z - now.eye.z, -2.0, 1e-9);
    }
}

} // namespace
} // namespace reljef::bench
