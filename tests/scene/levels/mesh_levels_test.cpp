#include "engine/scene/levels/mesh_levels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stop_token>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "engine/scene/levels/mesh_distance.h"

namespace reljef::scene {
namespace {

double triangles_in(const Mesh& mesh) {
    return static_cast<double>(mesh.indices.size()) / 3.0;
}

// A sphere with bumps: smooth, closed, with a seam of texture coordinates.
Mesh bumpy_sphere(int segments) {
    Mesh mesh = sphere_mesh(10.0F, segments);
    for (glm::vec3& place : mesh.positions) {
        const glm::vec3 at = place;
        place *= 1.0F + 0.05F * std::sin(1.3F * at.x) * std::sin(0.9F * at.y + at.z);
    }
    return mesh;
}

glm::dvec3 random_point_on(const Mesh& mesh, std::mt19937& random) {
    std::uniform_int_distribution<std::size_t> triangle(0, mesh.indices.size() / 3 - 1);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    const TriangleEdges edges = triangle_edges(mesh, 3 * triangle(random));
    double s = share(random);
    double t = share(random);
    if (s + t > 1.0) {
        s = 1.0 - s;
        t = 1.0 - t;
    }
    return edges.corner + s * edges.p + t * edges.q;
}

double brute_distance(const Mesh& mesh, glm::dvec3 point) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        nearest = std::min(nearest,
                           glm::distance(point, nearest_point(triangle_corners(mesh, i), point)));
    }
    return nearest;
}

TEST(NearestPoint, IsNoFartherThanAnyPointOfTheTriangle) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(-1.0, 1.0);
    const auto point = [&] { return glm::dvec3(place(random), place(random), place(random)); };
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 a = point();
        const glm::dvec3 b = i % 7 == 0 ? a : point();
        const glm::dvec3 c = i % 5 == 0 ? 0.5 * (a + b) : point(); // a line, or a point
        const glm::dvec3 from = 2.0 * point();
        const glm::dvec3 nearest = nearest_point({a, b, c}, from);
        const double distance = glm::distance(from, nearest);
        for (int j = 0; j < 30; ++j) {
            const double u = 0.5 + 0.5 * place(random);
            const double v = (1.0 - u) * (0.5 + 0.5 * place(random));
            EXPECT_GE(glm::distance(from, a + u * (b - a) + v * (c - a)), distance - 1e-12);
        }
    }
}

TEST(MeshTree, NearestTriangleIsThatOfAll) {
    const Mesh mesh = bumpy_sphere(24);
    const MeshTree tree(mesh);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> place(-20.0, 20.0);
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 point(place(random), place(random), place(random));
        const auto corners = triangle_corners(mesh, tree.nearest_triangle(point));
        EXPECT_DOUBLE_EQ(glm::distance(point, nearest_point(corners, point)),
                         brute_distance(mesh, point));
    }
}

TEST(MeshDistance, IsNoLessThanAtThousandsOfPoints) {
    std::mt19937 random(3);
    for (const int segments : {12, 20, 34}) {
        const Mesh fine = bumpy_sphere(64);
        const Mesh coarse = bumpy_sphere(segments);
        const auto distance = max_distance_between(fine, coarse);
        ASSERT_TRUE(distance);
        double largest = 0.0;
        const MeshTree fine_tree(fine);
        const MeshTree coarse_tree(coarse);
        const auto measure = [&](const Mesh& from, const MeshTree& to) {
            const glm::dvec3 point = random_point_on(from, random);
            const auto corners = triangle_corners(to.mesh(), to.nearest_triangle(point));
            largest = std::max(largest, glm::distance(point, nearest_point(corners, point)));
        };
        for (int i = 0; i < 20'000; ++i) {
            measure(fine, coarse_tree);
            measure(coarse, fine_tree);
        }
        EXPECT_GE(*distance, largest);
        EXPECT_LE(*distance, 1.3 * largest); // an eighth, and points that were not met
    }
}

// Vertices of one mesh may all lie on the other one, and points between them far from it.
TEST(MeshDistance, OfPointsBetweenVerticesCounts) {
    Mesh level = plane_mesh(glm::vec2(10.0F));
    Mesh tent = level; // over the diagonal
    tent.positions.emplace_back(0.0F, 0.0F, 2.0F);
    tent.normals.emplace_back(0.0F, 0.0F, 1.0F);
    tent.texture_coordinates.emplace_back(0.5F, 0.5F);
    tent.indices = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
    const auto distance = max_distance_between(level, tent);
    ASSERT_TRUE(distance);
    EXPECT_GE(*distance, 2.0);
    EXPECT_LE(*distance, 2.0 * 1.126);
    const auto only_from_level = max_distance(level, MeshTree(tent), 0.0);
    ASSERT_TRUE(only_from_level);
    EXPECT_GE(*only_from_level, 10.0 / std::sqrt(29.0) - 1e-9); // the middle, to a face
}

TEST(MeshDistance, OfVerticesWithoutTrianglesDoesNotCount) {
    const Mesh level = plane_mesh(glm::vec2(10.0F));
    Mesh other = level;
    other.positions.emplace_back(0.0F, 0.0F, 1000.0F);
    other.positions.front().z = 0.5F; // a corner
    const auto distance = max_distance_between(other, level);
    ASSERT_TRUE(distance);
    EXPECT_LT(*distance, 0.6);
}

TEST(MeshDistance, OfEqualPlanesInOtherTrianglesIsRounding) {
    const Mesh level = plane_mesh(glm::vec2(10.0F));
    Mesh other = level;
    other.indices = {1, 2, 3, 1, 3, 0}; // the other diagonal
    const auto distance = max_distance_between(level, other);
    ASSERT_TRUE(distance);
    EXPECT_LT(*distance, 1e-5);
}

TEST(MeshLevels, HaveAQuarterOfTheTrianglesAndGrowingErrors) {
    const Mesh mesh = bumpy_sphere(128);
    const auto levels = mesh_levels(mesh);
    ASSERT_TRUE(levels);
    ASSERT_GE(levels->size(), 3U);
    double before = triangles_in(mesh);
    double error = 0.0;
    std::mt19937 random(4);
    for (const MeshLevel& level : *levels) {
        EXPECT_LE(triangles_in(*level.mesh), 0.5 * before);
        EXPECT_EQ(level.mesh->normals.size(), level.mesh->positions.size());
        EXPECT_GT(level.error, error);
        EXPECT_LT(level.error, 5.0);
        for (int i = 0; i < 300; ++i) {
            EXPECT_LE(brute_distance(*level.mesh, random_point_on(mesh, random)), level.error);
            EXPECT_LE(brute_distance(mesh, random_point_on(*level.mesh, random)), level.error);
        }
        before = triangles_in(*level.mesh);
        error = level.error;
    }
}

TEST(MeshLevels, AreTheSameOnAnyNumberOfThreads) {
    const Mesh mesh = bumpy_sphere(64);
    const auto one = mesh_levels(mesh, {1U, {}, {}});
    const auto four = mesh_levels(mesh, {4U, {}, {}});
    ASSERT_TRUE(one && four);
    ASSERT_EQ(one->size(), four->size());
    ASSERT_FALSE(one->empty());
    for (std::size_t i = 0; i < one->size(); ++i) {
        EXPECT_EQ((*one)[i].error, (*four)[i].error);
        EXPECT_EQ((*one)[i].mesh->indices, (*four)[i].mesh->indices);
    }
}

// Each corner of a box of many squares has a normal for each side.
TEST(MeshLevels, OfFlatShadedMeshesKeepTheirSharpEdges) {
    Mesh mesh;
    const int squares = 40;
    for (int side = 0; side < 6; ++side) {
        const int axis = side % 3;
        const float sign = side < 3 ? 1.0F : -1.0F;
        glm::vec3 normal(0.0F);
        normal[axis] = sign;
        glm::vec3 u(0.0F);
        u[(axis + 1) % 3] = 1.0F;
        const glm::vec3 v = glm::cross(normal, u);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (int row = 0; row <= squares; ++row) {
            for (int col = 0; col <= squares; ++col) {
                const glm::vec2 at = glm::vec2(col, row) / static_cast<float>(squares) - 0.5F;
                mesh.positions.push_back(0.5F * normal + at.x * u + at.y * v);
                mesh.normals.push_back(normal);
                mesh.texture_coordinates.push_back(at);
            }
        }
        for (std::uint32_t row = 0; row < squares; ++row) {
            for (std::uint32_t col = 0; col < squares; ++col) {
                const std::uint32_t a = first + row * (squares + 1) + col;
                const std::uint32_t b = a + squares + 1;
                mesh.indices.insert(mesh.indices.end(), {a, a + 1, b + 1, a, b + 1, b});
            }
        }
    }
    const auto levels = mesh_levels(mesh);
    ASSERT_TRUE(levels);
    ASSERT_GE(levels->size(), 2U);
    const MeshLevel& last = levels->back();
    EXPECT_LT(last.error, 1e-4);
    for (std::size_t i = 0; i < last.mesh->indices.size(); i += 3) {
        const TriangleEdges edges = triangle_edges(*last.mesh, i);
        const glm::dvec3 across = glm::cross(edges.p, edges.q);
        if (glm::length(across) == 0.0) {
            continue; // draws nothing
        }
        for (std::size_t corner = i; corner < i + 3; ++corner) {
            const glm::dvec3 normal(last.mesh->normals[last.mesh->indices[corner]]);
            EXPECT_GT(glm::dot(glm::normalize(across), normal), 0.99);
        }
    }
}

// Smooth normals on flat faces: levels have the places of the mesh, and other light.
TEST(MeshLevels, KnowWhereTheirNormalsLookOtherwise) {
    Mesh mesh = bumpy_sphere(128);
    for (glm::vec3& place : mesh.positions) {
        place.z = 0.0F; // two discs
    }
    const auto levels = mesh_levels(mesh);
    ASSERT_TRUE(levels && levels->size() >= 2U);
    EXPECT_LT(levels->front().error, 1.0);
    EXPECT_GT(levels->back().shaded_width, 1.0);
    const auto of_ball = mesh_levels(sphere_mesh(10.0F, 128));
    ASSERT_TRUE(of_ball && !of_ball->empty());
    EXPECT_LT(of_ball->front().shaded_width, 1.0);
}

TEST(MeshLevels, OfSmallAndEmptyMeshesAreNone) {
    EXPECT_TRUE(mesh_levels(Mesh{})->empty());
    EXPECT_TRUE(mesh_levels(sphere_mesh(1.0F, 32))->empty());
}

// Open borders meet those of other parts of an object.
TEST(MeshLevels, KeepOpenBorders) {
    const Mesh mesh = bowl_mesh(5.0F, 256);
    const auto levels = mesh_levels(mesh);
    ASSERT_TRUE(levels && !levels->empty());
    for (const MeshLevel& level : *levels) {
        const auto rim = std::ranges::count_if(level.mesh->positions,
                                               [](glm::vec3 place) { return place.z == 0.0F; });
        EXPECT_GE(rim, 256);
    }
}

TEST(MeshLevels, EndWhenTheyAreStopped) {
    std::stop_source stop;
    stop.request_stop();
    EXPECT_FALSE(mesh_levels(bumpy_sphere(128), {0U, stop.get_token(), {}}));
}

} // namespace
} // namespace reljef::scene
