#include "engine/io/mesh/corner_mesh.h"

#include <cmath>
#include <numbers>
#include <random>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

namespace reljef::io {
namespace {

void add_triangle(scene::Mesh& mesh, glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    mesh.positions.insert(mesh.positions.end(), {a, b, c});
    mesh.normals.resize(mesh.positions.size(), glm::vec3(0.0F));
    mesh.texture_coordinates.resize(mesh.positions.size(), glm::vec2(0.0F));
}

// Triangles that turn all ways, each with a corner at one of some places.
scene::Mesh random_triangles(int count, int places, unsigned seed) {
    std::mt19937 chance(seed);
    std::normal_distribution<float> any;
    const auto direction = [&] {
        return glm::normalize(glm::vec3(any(chance), any(chance), any(chance)));
    };
    scene::Mesh mesh;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 place(static_cast<float>(i % places), 0.0F, 0.0F);
        add_triangle(mesh, place, place + direction(), place + direction());
    }
    return mesh;
}

glm::vec3 triangle_normal(const scene::Mesh& mesh, std::size_t corner) {
    const std::size_t first = corner / 3 * 3;
    return glm::normalize(glm::cross(mesh.positions[first + 1] - mesh.positions[first],
                                     mesh.positions[first + 2] - mesh.positions[first]));
}

// From all pairs of corners.
glm::vec3 mean_normal(const scene::Mesh& mesh, std::size_t corner, float min_cosine) {
    glm::vec3 sum(0.0F);
    const glm::vec3 own = triangle_normal(mesh, corner);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::vec3 other = triangle_normal(mesh, i);
        const bool is_near = i == corner || glm::dot(own, other) >= min_cosine;
        sum += mesh.positions[i] == mesh.positions[corner] && is_near ? other : glm::vec3(0.0F);
    }
    return glm::normalize(sum);
}

TEST(CornerMesh, NormalsAreThoseOfAllPairsOfCorners) {
    for (const float hard_edge : {20.0F, 45.0F, 120.0F}) {
        const scene::Mesh bare = random_triangles(300, 4, 7);
        scene::Mesh mesh = bare;
        add_missing_normals(mesh, hard_edge);
        for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
            const glm::vec3 expected = mean_normal(bare, i, std::cos(glm::radians(hard_edge)));
            EXPECT_LT(glm::distance(mesh.normals[i], expected), 1e-4F) << i << " " << hard_edge;
        }
    }
}

TEST(CornerMesh, NormalsOfManyDirectionsAreNearThoseOfTheirTriangles) {
    scene::Mesh mesh = random_triangles(20'000, 1, 8);
    add_missing_normals(mesh, 45.0F);
    for (std::size_t i = 0; i < mesh.normals.size(); i += 3) {
        EXPECT_GT(glm::dot(mesh.normals[i], triangle_normal(mesh, i)), 0.85F) << i;
    }
}

TEST(CornerMesh, GivenNormalsStayAndTrianglesWithoutAreaHaveNone) {
    scene::Mesh mesh;
    add_triangle(mesh, {0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F});
    add_triangle(mesh, {0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {2.0F, 0.0F, 0.0F});
    mesh.normals[0] = {1.0F, 0.0F, 0.0F};
    mesh.normals[1] = {std::nanf(""), 0.0F, 0.0F};
    add_missing_normals(mesh, 45.0F);
    EXPECT_EQ(mesh.normals[0], glm::vec3(1.0F, 0.0F, 0.0F));
    EXPECT_EQ(mesh.normals[1], glm::vec3(0.0F, 0.0F, 1.0F));
    EXPECT_EQ(mesh.normals[2], glm::vec3(0.0F, 0.0F, 1.0F));
    EXPECT_EQ(mesh.normals[3], glm::vec3(0.0F));
}

TEST(CornerMesh, EqualCornersBecomeOneVertex) {
    scene::Mesh corners;
    for (int i = 0; i < 1000; ++i) {
        const float x = static_cast<float>(i);
        add_triangle(corners, {x, 0.0F, 0.0F}, {x + 1.0F, 0.0F, 0.0F}, {x, 1.0F, 0.0F});
        add_triangle(corners, {x + 1.0F, 0.0F, 0.0F}, {x + 1.0F, 1.0F, 0.0F}, {x, 1.0F, 0.0F});
    }
    corners.texture_coordinates[0] = {0.5F, 0.0F}; // nothing else is at this place
    corners.texture_coordinates[3] = {0.5F, 0.0F}; // of another place than its neighbours
    const scene::Mesh mesh = joined_corners(corners);
    EXPECT_EQ(mesh.positions.size(), 2U * 1001U + 1U);
    ASSERT_EQ(mesh.indices.size(), corners.positions.size());
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        ASSERT_LT(mesh.indices[i], mesh.positions.size());
        EXPECT_EQ(mesh.positions[mesh.indices[i]], corners.positions[i]);
        EXPECT_EQ(mesh.normals[mesh.indices[i]], corners.normals[i]);
        EXPECT_EQ(mesh.texture_coordinates[mesh.indices[i]], corners.texture_coordinates[i]);
    }
}

} // namespace
} // namespace reljef::io
