#include "engine/scene/motion/animators.h"

#include <cmath>
#include <limits>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace reljef::scene {
namespace {

CameraPath path_along_x() {
    return CameraPath::create({{1.0, {0.0, 0.0, 0.0}, {0.0, 9.0, 0.0}}, {3.0, {8.0, 0.0, 0.0}, {}}})
        .value();
}

double x_at(double time) {
    Node node("camera", Camera{});
    node.add_animator(camera_path_animator(path_along_x()));
    node.animate(time);
    return node.get<Camera>()->eye.x;
}

TEST(FlyPathAnimator, RunsFromTheBeginningAndStartsAgainAtTheEnd) {
    EXPECT_EQ(x_at(0.0), 0.0);
    EXPECT_EQ(x_at(1.0), 4.0);
    EXPECT_EQ(x_at(2.0), 0.0);
    EXPECT_NEAR(x_at(7.0), 4.0, 1e-12);
    EXPECT_NEAR(x_at(-1.0), 4.0, 1e-12);
}

TEST(FlyPathAnimator, StaysOnThePathWhateverTheTime) {
    for (const double time : {1e300, -1e300, std::numeric_limits<double>::infinity(), std::nan(""),
                              std::numeric_limits<double>::denorm_min(), -1e-300}) {
        EXPECT_GE(x_at(time), 0.0) << time;
        EXPECT_LE(x_at(time), 8.0) << time;
    }
}

TEST(FlyPathAnimator, LeavesANodeWithoutACameraAlone) {
    Node node("light", Light{});
    node.add_animator(camera_path_animator(path_along_x()));
    node.animate(1.0);
    EXPECT_EQ(node.world_from_local(), glm::dmat4(1.0));
}

TEST(FlyPathAnimator, OfASingleKeyStandsThere) {
    Node node("camera", Camera{});
    node.add_animator(
        camera_path_animator(CameraPath::create({{5.0, {1.0, 2.0, 3.0}, {}}}).value()));
    node.animate(77.0);
    EXPECT_EQ(node.get<Camera>()->eye, glm::dvec3(1.0, 2.0, 3.0));
}

TEST(RotationAnimator, TurnsCounterClockwiseInItsPlace) {
    Node node("mesh");
    node.set_position({10.0, 20.0, 30.0});
    node.add_animator(rotation_animator(45.0));
    node.animate(2.0);
    const glm::dvec3 east(node.world_from_local() * glm::dvec4(1.0, 0.0, 0.0, 1.0));
    EXPECT_LE(glm::distance(east, {10.0, 21.0, 30.0}), 1e-12);
}

// Turned from where it stood, not a little more with every frame.
TEST(RotationAnimator, DependsOnTheTimeAlone) {
    Node node("mesh");
    node.add_animator(rotation_animator(10.0));
    for (int i = 0; i < 100; ++i) {
        node.animate(0.1 * i);
    }
    node.animate(0.0);
    EXPECT_LE(glm::distance(node.world_from_local()[0], {1.0, 0.0, 0.0, 0.0}), 1e-12);
}

TEST(RotationAnimator, KeepsTheNodesOwnSize) {
    Node node("mesh");
    node.set_parent_from_local(glm::scale(glm::dmat4(1.0), glm::dvec3(2.0, 3.0, 4.0)));
    node.add_animator(rotation_animator(90.0));
    for (int i = 0; i < 5; ++i) {
        node.animate(1.0 * i);
    }
    const glm::dmat4 transform = node.world_from_local();
    EXPECT_NEAR(glm::length(transform[0]), 2.0, 1e-9);
    EXPECT_NEAR(glm::length(transform[1]), 3.0, 1e-9);
    EXPECT_NEAR(glm::length(transform[2]), 4.0, 1e-9);
}

} // namespace
} // namespace reljef::scene
