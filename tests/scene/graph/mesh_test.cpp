#include "engine/scene/graph/mesh.h"

#include <array>
#include <map>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace reljef::scene {
namespace {

using Place = std::array<float, 3>;

Place place_of(const Mesh& mesh, std::uint32_t index) {
    const glm::vec3& p = mesh.positions[index];
    return {p.x + 0.0F, p.y + 0.0F, p.z + 0.0F};
}

// A closed surface runs along each edge as often one way as the other.
void expect_closed(const Mesh& mesh) {
    std::map<std::pair<Place, Place>, int> balance;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Place from = place_of(mesh, mesh.indices[i + k]);
            const Place to = place_of(mesh, mesh.indices[i + (k + 1) % 3]);
            ++balance[{from, to}];
            --balance[{to, from}];
        }
    }
    for (const auto& [edge, count] : balance) {
        ASSERT_TRUE(count == 0 || edge.first == edge.second)
            << edge.first[0] << ' ' << edge.first[1] << ' ' << edge.first[2];
    }
}

// Each triangle is turned as its vertices' normals are.
void expect_facing_their_normals(const Mesh& mesh) {
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const glm::vec3 a = mesh.positions[mesh.indices[i]];
        const glm::vec3 b = mesh.positions[mesh.indices[i + 1]];
        const glm::vec3 c = mesh.positions[mesh.indices[i + 2]];
        for (std::size_t k = 0; k < 3; ++k) {
            ASSERT_GE(glm::dot(glm::cross(b - a, c - a), mesh.normals[mesh.indices[i + k]]),
                      -1e-6F);
        }
    }
}

void expect_outward(const Mesh& mesh) {
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    ASSERT_EQ(mesh.texture_coordinates.size(), mesh.positions.size());
    ASSERT_EQ(mesh.indices.size() % 3, 0U);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const glm::vec3 a = mesh.positions[mesh.indices[i]];
        const glm::vec3 b = mesh.positions[mesh.indices[i + 1]];
        const glm::vec3 c = mesh.positions[mesh.indices[i + 2]];
        const glm::vec3 normal = glm::cross(b - a, c - a);
        // These shapes are convex around the origin; triangles at a sphere's poles may have no
        // area.
        ASSERT_GE(glm::dot(normal, a + b + c), -1e-6F);
    }
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
        ASSERT_NEAR(glm::length(mesh.normals[i]), 1.0F, 1e-6F);
        ASSERT_GT(glm::dot(mesh.normals[i], mesh.positions[i]), 0.0F);
    }
}

TEST(BoxMesh, IsClosedOutwardAndAsLargeAsAsked) {
    const Mesh mesh = box_mesh({2.0F, 4.0F, 6.0F});
    expect_closed(mesh);
    expect_outward(mesh);
    EXPECT_EQ(bounds_of(mesh).low, glm::dvec3(-1.0, -2.0, -3.0));
    EXPECT_EQ(bounds_of(mesh).high, glm::dvec3(1.0, 2.0, 3.0));
    EXPECT_EQ(mesh.indices.size(), 36U);
}

TEST(SphereMesh, IsClosedOutwardAndRound) {
    for (const int segments : {-1, 3, 4, 7, 48}) {
        const Mesh mesh = sphere_mesh(5.0F, segments);
        expect_closed(mesh);
        expect_outward(mesh);
        for (const glm::vec3& position : mesh.positions) {
            ASSERT_NEAR(glm::length(position), 5.0F, 1e-5F);
        }
    }
}

// As a sphere's, but for the edge.
TEST(BowlMesh, IsTheLowerHalfOfASphere) {
    for (const int segments : {-1, 3, 7, 48}) {
        const Mesh mesh = bowl_mesh(2.0F, segments);
        expect_outward(mesh);
        EXPECT_EQ(bounds_of(mesh).high.z, 0.0);
        EXPECT_NEAR(bounds_of(mesh).low.z, -2.0, 1e-6);
        for (const glm::vec3& position : mesh.positions) {
            ASSERT_NEAR(glm::length(position), 2.0F, 1e-5F);
        }
    }
}

TEST(CylinderMesh, IsClosedOutwardAndAsLargeAsAsked) {
    for (const int segments : {-1, 3, 4, 7, 48}) {
        const Mesh mesh = cylinder_mesh(2.0F, 6.0F, segments);
        expect_closed(mesh);
        expect_outward(mesh);
        expect_facing_their_normals(mesh);
        EXPECT_EQ(bounds_of(mesh).high.z, 3.0);
        EXPECT_EQ(bounds_of(mesh).low.z, -3.0);
        EXPECT_NEAR(bounds_of(mesh).high.x, 2.0, 1e-6);
    }
}

TEST(TorusMesh, IsClosedAndATubeAroundItsRing) {
    for (const int segments : {-1, 3, 7, 48}) {
        const Mesh mesh = torus_mesh(3.0F, 0.75F, segments);
        expect_closed(mesh);
        if (segments > 7) {
            expect_facing_their_normals(mesh);
        }
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            const glm::vec3 p = mesh.positions[i];
            const glm::vec3 ring = 3.0F * glm::normalize(glm::vec3(p.x, p.y, 0.0F));
            ASSERT_LT(glm::distance(p - ring, 0.75F * mesh.normals[i]), 1e-5F);
        }
    }
}

TEST(PlaneMesh, FacesUpWithThePicturesFirstRowInTheNorth) {
    const Mesh mesh = plane_mesh({4.0F, 2.0F});
    expect_facing_their_normals(mesh);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        EXPECT_EQ(mesh.positions[i].x, 4.0F * (mesh.texture_coordinates[i].x - 0.5F));
        EXPECT_EQ(mesh.positions[i].y, 2.0F * (0.5F - mesh.texture_coordinates[i].y));
        EXPECT_EQ(mesh.normals[i], glm::vec3(0.0F, 0.0F, 1.0F));
    }
}

TEST(Mesh, WithoutVerticesHasEmptyBounds) {
    EXPECT_TRUE(bounds_of({}).empty());
}

} // namespace
} // namespace reljef::scene
