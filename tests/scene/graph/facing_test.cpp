#include "engine/scene/graph/facing.h"

#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "engine/scene/graph/scene.h"

namespace reljef::scene {
namespace {

glm::dmat4 any_transform() {
    const glm::dmat4 moved = glm::translate(glm::dmat4(1.0), {7.0, 8.0, 9.0});
    const glm::dmat4 turned_node = glm::rotate(moved, 0.4, glm::dvec3(1.0, 2.0, 3.0));
    return glm::scale(turned_node, {2.0, 3.0, 4.0});
}

Camera looking(glm::dvec3 forward) {
    Camera camera;
    camera.eye = {100.0, 200.0, 300.0};
    camera.target = camera.eye + forward;
    return camera;
}

TEST(Facing, OfTheNodeChangesNothing) {
    EXPECT_EQ(faced(Facing::node, any_transform(), looking({1.0, 1.0, 0.0})), any_transform());
}

TEST(Facing, TheCameraHasTheAxesOfThePicture) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (int i = 0; i < 100; ++i) {
        const Camera camera = looking({any(random), any(random), any(random)});
        const ViewAxes axes = view_axes(camera);
        const glm::dmat4 transform = faced(Facing::camera, any_transform(), camera);
        EXPECT_LE(glm::distance(glm::dvec3(transform[0]), 2.0 * axes.right), 1e-9);
        EXPECT_LE(glm::distance(glm::dvec3(transform[1]), 3.0 * axes.forward), 1e-9);
        EXPECT_LE(glm::distance(glm::dvec3(transform[2]), 4.0 * axes.up), 1e-9);
        EXPECT_EQ(transform[3], any_transform()[3]);
    }
}

TEST(Facing, UprightTurnsAboutTheNodesVertical) {
    for (const glm::dvec3 forward :
         {glm::dvec3(1.0, 0.0, 0.0), {-1.0, 2.0, -3.0}, {0.0, 0.0, -1.0}}) {
        const Camera camera = looking(forward);
        const glm::dmat4 node = glm::scale(glm::dmat4(1.0), {2.0, 1.0, 5.0});
        const glm::dmat4 transform = faced(Facing::upright, node, camera);
        EXPECT_LE(glm::distance(glm::dvec3(transform[2]), {0.0, 0.0, 5.0}), 1e-12);
        EXPECT_LE(glm::distance(glm::dvec3(transform[0]), 2.0 * view_axes(camera).right), 1e-9);
        EXPECT_NEAR(glm::determinant(glm::dmat3(transform)), 10.0, 1e-9) << "not mirrored";
        EXPECT_GE(glm::dot(glm::dvec3(transform[1]), forward), -1e-9) << "y leads away";
    }
    const glm::dmat4 leaning = any_transform();
    const glm::dmat4 transform = faced(Facing::upright, leaning, looking({1.0, 0.0, 0.0}));
    EXPECT_LE(glm::distance(transform[2], leaning[2]), 1e-9);
}

TEST(Facing, ACameraOnItsSideIsNoException) {
    Camera camera = looking({0.0, 1.0, 0.0});
    camera.up = {1.0, 0.0, 0.0};
    const glm::dmat4 transform = faced(Facing::upright, glm::dmat4(1.0), camera);
    EXPECT_NEAR(glm::determinant(glm::dmat3(transform)), 1.0, 1e-9);
    EXPECT_LE(glm::distance(glm::dvec3(transform[1]), {0.0, 1.0, 0.0}), 1e-9);
}

TEST(Facing, WhatHasNoSizeStaysAsItIs) {
    const glm::dmat4 flat = glm::scale(glm::dmat4(1.0), {1.0, 0.0, 1.0});
    EXPECT_EQ(faced(Facing::camera, flat, looking({1.0, 0.0, 0.0})), flat);
}

TEST(Facing, BoundsHoldTheMeshFromWhereverItIsSeen) {
    Scene scene;
    Node& node = scene.add_mesh(billboard_mesh({4.0F, 10.0F}));
    node.get<MeshNode>()->facing = Facing::camera;
    node.set_parent_from_local(any_transform());
    const Box bounds = node.world_bounds();
    std::mt19937 random(2);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (int i = 0; i < 100; ++i) {
        const glm::dmat4 transform = faced(Facing::camera, any_transform(),
                                           looking({any(random), any(random), any(random)}));
        const Box seen = reljef::transformed(transform, node.local_bounds());
        EXPECT_TRUE(glm::all(glm::greaterThanEqual(seen.low, bounds.low - 1e-9)));
        EXPECT_TRUE(glm::all(glm::lessThanEqual(seen.high, bounds.high + 1e-9)));
    }
    EXPECT_TRUE(turned_bounds({}).empty());
}

} // namespace
} // namespace reljef::scene
