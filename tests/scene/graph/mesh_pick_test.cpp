#include "engine/scene/graph/mesh_pick.h"

#include <cmath>
#include <limits>
#include <random>
#include <thread>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace reljef::scene {
namespace {

constexpr reljef::Interval onward{0.0, std::numeric_limits<double>::infinity()};

glm::dvec3 any_direction(std::mt19937& random) {
    std::normal_distribution<double> axis;
    return glm::normalize(glm::dvec3(axis(random), axis(random), axis(random)));
}

TEST(MeshTree, MeetsABoxFromOutside) {
    const Mesh box = box_mesh({2.0F, 4.0F, 6.0F});
    const MeshTree tree(box);
    const auto hit = tree.first_hit({{0.5, 1.0, 103.0}, {0.0, 0.0, -2.0}}, onward);
    ASSERT_TRUE(hit);
    EXPECT_DOUBLE_EQ(hit->t, 50.0);
    EXPECT_NEAR(
        glm::cross(triangle_edges(box, hit->triangle).p, triangle_edges(box, hit->triangle).q).z,
        8.0, 1e-12);
    EXPECT_FALSE(tree.first_hit({{0.5, 1.0, 103.0}, {0.0, 0.0, -2.0}}, {0.0, 49.9}));
    EXPECT_FALSE(tree.first_hit({{0.5, 1.0, 103.0}, {0.0, 0.0, -2.0}}, {50.1, 60.0}));
    EXPECT_FALSE(tree.first_hit({{0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}}, onward)) << "from inside";
    EXPECT_FALSE(tree.first_hit({{1.5, 1.0, 103.0}, {0.0, 0.0, -2.0}}, onward)) << "beside";
}

// At their vertices and on their edges, too, where two triangles share what rounds.
TEST(MeshTree, NoRayPassesBetweenTheTrianglesOfAClosedMesh) {
    for (const Mesh& mesh : {sphere_mesh(3.0F, 24), box_mesh({1.0F, 2.0F, 3.0F})}) {
        const MeshTree tree(mesh);
        std::mt19937 random(17);
        std::uniform_int_distribution<std::size_t> any_triangle(0, mesh.indices.size() / 3 - 1);
        std::uniform_real_distribution<double> share(0.0, 1.0);
        for (int i = 0; i < 30'000; ++i) {
            const TriangleEdges edges = triangle_edges(mesh, 3 * any_triangle(random));
            const double along = i % 3 == 0 ? 0.0 : share(random);
            const glm::dvec3 on_edge = edges.corner + along * (i % 2 == 0 ? edges.p : edges.q);
            const glm::dvec3 from = on_edge + (i % 4 < 2 ? 5e3 : 1e6) * any_direction(random);
            const glm::dvec3 inside = 0.5 * on_edge; // through the edge, into the mesh, and out
            const auto seen = tree.first_hit({from, inside - from}, {0.0, 1.0});
            ASSERT_TRUE(seen) << i;
            ASSERT_TRUE(tree.first_hit({2.0 * on_edge, -on_edge}, onward)) << i;
        }
    }
}

// Boxes of faces along the axes are flat: what rounds at the origin's size must not miss them.
TEST(MeshTree, MeetsFromFarAwayWhatAllTrianglesMeet) {
    for (const Mesh& mesh :
         {box_mesh({14.0F, 9.0F, 31.0F}), sphere_mesh(7.0F, 40), torus_mesh(14.0F, 4.0F)}) {
        const MeshTree tree(mesh);
        std::mt19937 random(23);
        std::uniform_int_distribution<std::size_t> any_triangle(0, mesh.indices.size() / 3 - 1);
        std::uniform_real_distribution<double> share(0.0, 1.0);
        for (int i = 0; i < 20'000; ++i) {
            const TriangleEdges edges = triangle_edges(mesh, 3 * any_triangle(random));
            const double along = i % 2 == 0 ? share(random) : 0.0;
            const glm::dvec3 at =
                edges.corner + along * edges.p + (1.0 - along) * share(random) * edges.q;
            const glm::dvec3 from = at + 1e6 * any_direction(random);
            const Ray ray{from, at - from};
            const auto seen = tree.first_hit(ray, onward);
            const auto expected = first_hit(mesh, ray, onward);
            ASSERT_EQ(seen.has_value(), expected.has_value()) << i;
            if (seen) {
                ASSERT_EQ(seen->t, expected->t) << i;
            }
        }
    }
}

TEST(MeshTree, WhatIsNoRayAndWhatIsNoTriangleMeetNothing) {
    const Mesh box = box_mesh(glm::vec3(2.0F));
    const MeshTree tree(box);
    EXPECT_FALSE(tree.first_hit({{0.0, 0.0, 5.0}, {0.0, 0.0, 0.0}}, onward));
    EXPECT_FALSE(tree.first_hit({{0.0, 0.0, std::nan("")}, {0.0, 0.0, -1.0}}, onward));
    EXPECT_FALSE(tree.first_hit({{HUGE_VAL, 0.0, 5.0}, {0.0, 0.0, -1.0}}, onward));
    Mesh line = box;
    line.positions.assign(line.positions.size(), {1.0F, 1.0F, 1.0F});
    EXPECT_FALSE(MeshTree(line).first_hit({{1.0, 1.0, 5.0}, {0.0, 0.0, -1.0}}, onward));
    const Mesh none;
    EXPECT_FALSE(MeshTree(none).first_hit({{1.0, 1.0, 5.0}, {0.0, 0.0, -1.0}}, onward));
}

// Its tree is made in the background.
TEST(MeshTrees, ALargeMeshIsMetBeforeItsTreeIsMade) {
    MeshTrees trees;
    const auto mesh = std::make_shared<const Mesh>(sphere_mesh(5.0F, 240));
    ASSERT_GT(mesh->indices.size() / 3, 50'000U);
    std::mt19937 random(3);
    const auto expect_hits = [&] {
        for (int i = 0; i < 20; ++i) {
            const glm::dvec3 from = 50.0 * any_direction(random);
            const Ray ray{from, any_direction(random) - from};
            const auto hit = trees.first_hit(mesh, ray, onward);
            ASSERT_TRUE(hit);
            EXPECT_EQ(hit->t, first_hit(*mesh, ray, onward)->t);
        }
    };
    expect_hits();
    while (mesh.use_count() > 1) { // until it is made
        std::this_thread::yield();
    }
    expect_hits();
    MeshTrees stopped;
    EXPECT_TRUE(stopped.first_hit(mesh, {{0.0, 0.0, 9.0}, {0.0, 0.0, -1.0}}, onward));
}

TEST(MeshTrees, DoNotKeepMeshesAlive) {
    MeshTrees trees;
    auto mesh = std::make_shared<const Mesh>(box_mesh(glm::vec3(2.0F)));
    const Ray down{{0.0, 0.0, 5.0}, {0.0, 0.0, -1.0}};
    EXPECT_DOUBLE_EQ(trees.first_hit(mesh, down, onward)->t, 4.0);
    EXPECT_EQ(mesh.use_count(), 1);
    mesh = std::make_shared<const Mesh>(box_mesh(glm::vec3(4.0F)));
    EXPECT_DOUBLE_EQ(trees.first_hit(mesh, down, onward)->t, 3.0);
    EXPECT_FALSE(trees.first_hit(std::make_shared<const Mesh>(), down, onward));
}

} // namespace
} // namespace reljef::scene
