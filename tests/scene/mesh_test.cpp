#include "engine/scene/mesh.h"

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

void expect_outward(const Mesh& mesh) {
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    ASSERT_EQ(mesh.texture_coordinates.size(), mesh.positions.size());
    ASSERT_EQ(mesh.indices.size() % 3, 0U);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const glm::vec3 a = mesh.positions[mesh.indices[i]];
        const glm::vec3 b = mesh.positions[mesh.indices[i + 1]];
        const glm::vec3 c = mesh.positions[mesh.indices[i + 2]];
        const glm::vec3 normal = glm::cross(b - a, c - a);
        // Both shapes are convex around the origin; triangles at a sphere's poles may have no area.
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

TEST(Mesh, WithoutVerticesHasEmptyBounds) {
    EXPECT_TRUE(bounds_of({}).empty());
}

} // namespace
} // namespace reljef::scene
