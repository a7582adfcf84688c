#include "engine/scene/graph/tangent_frames.h"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "tests/terrain/chance.h"

namespace reljef::scene {
namespace {

glm::vec3 bitangent(const TangentFrame& frame, glm::vec3 normal) {
    return frame.handedness * glm::cross(normal, frame.tangent);
}

constexpr float unit_error = 1e-6F; // a few roundings of a float near 1

void expect_orthonormal(const Mesh& mesh, const std::vector<TangentFrame>& frames) {
    ASSERT_EQ(frames.size(), mesh.positions.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const TangentFrame& frame = frames[i];
        ASSERT_NEAR(glm::length(frame.tangent), 1.0F, unit_error);
        ASSERT_NEAR(glm::dot(frame.tangent, mesh.normals[i]), 0.0F, unit_error);
        ASSERT_EQ(std::abs(frame.handedness), 1.0F);
        ASSERT_NEAR(glm::length(bitangent(frame, mesh.normals[i])), 1.0F, 2.0F * unit_error);
        ASSERT_TRUE(std::isfinite(frame.density.x) && std::isfinite(frame.density.y));
        ASSERT_GE(std::min(frame.density.x, frame.density.y), 0.0F);
    }
}

Mesh triangle(std::array<glm::vec3, 3> corners, std::array<glm::vec2, 3> coordinates,
              glm::vec3 normal) {
    Mesh mesh;
    mesh.positions.assign(corners.begin(), corners.end());
    mesh.texture_coordinates.assign(coordinates.begin(), coordinates.end());
    mesh.normals.assign(3, normal);
    mesh.indices = {0, 1, 2};
    return mesh;
}

glm::vec3 direction(test::Chance& chance) {
    for (;;) {
        const glm::vec3 v(chance.between(-1.0, 1.0), chance.between(-1.0, 1.0),
                          chance.between(-1.0, 1.0));
        if (glm::length(v) > 0.1F) {
            return glm::normalize(v);
        }
    }
}

TEST(TangentFrames, OfAPlaneRunAlongItsAxesWithItsDensity) {
    const Mesh mesh = plane_mesh({4.0F, 2.0F});
    for (const TangentFrame& frame : tangent_frames(mesh)) {
        EXPECT_EQ(frame.tangent, glm::vec3(1.0F, 0.0F, 0.0F));
        EXPECT_EQ(frame.density, glm::vec2(0.25F, 0.5F));
        EXPECT_EQ(bitangent(frame, {0.0F, 0.0F, 1.0F}), glm::vec3(0.0F, -1.0F, 0.0F));
        EXPECT_EQ(frame.handedness, -1.0F);
    }
}

TEST(TangentFrames, AMirroredTextureTurnsTheHandednessOnly) {
    Mesh mesh = plane_mesh({2.0F, 2.0F});
    for (glm::vec2& coordinate : mesh.texture_coordinates) {
        coordinate.y = 1.0F - coordinate.y;
    }
    for (const TangentFrame& frame : tangent_frames(mesh)) {
        EXPECT_EQ(frame.tangent, glm::vec3(1.0F, 0.0F, 0.0F));
        EXPECT_EQ(frame.handedness, 1.0F);
    }
}

// A random affine map from texture coordinates to a plane in space: its columns are the gradients.
TEST(TangentFrames, FollowTheTextureOverAnyTriangle) {
    test::Chance chance(11);
    for (int i = 0; i < 4000; ++i) {
        const glm::vec3 u = direction(chance) * static_cast<float>(chance.between(0.01, 100.0));
        const glm::vec3 off = direction(chance);
        const glm::vec3 across = glm::cross(u, off);
        if (glm::length(across) < 0.2F * glm::length(u)) {
            continue;
        }
        const bool mirrored = chance.one_in(2);
        const glm::vec3 normal = glm::normalize(across);
        const glm::vec3 v = (mirrored ? -1.0F : 1.0F) * glm::cross(normal, u) *
                            static_cast<float>(chance.between(0.2, 5.0));
        std::array<glm::vec2, 3> coordinates{};
        std::array<glm::vec3, 3> corners{};
        for (std::size_t k = 0; k < 3; ++k) {
            coordinates[k] = {chance.between(-3.0, 3.0), chance.between(-3.0, 3.0)};
            corners[k] = coordinates[k].x * u + coordinates[k].y * v;
        }
        const glm::vec2 s = coordinates[1] - coordinates[0];
        const glm::vec2 t = coordinates[2] - coordinates[0];
        if (std::abs(s.x * t.y - s.y * t.x) < 0.3F) {
            continue;
        }
        const Mesh mesh = triangle(corners, coordinates, normal);
        const auto frames = tangent_frames(mesh);
        expect_orthonormal(mesh, frames);
        for (const TangentFrame& frame : frames) {
            ASSERT_LT(glm::distance(frame.tangent, glm::normalize(u)), 1e-3F);
            ASSERT_LT(glm::distance(bitangent(frame, normal), glm::normalize(v)), 1e-3F);
            ASSERT_NEAR(frame.density.x * glm::length(u), 1.0F, 1e-3F);
            ASSERT_NEAR(frame.density.y * glm::length(v), 1.0F, 1e-3F);
        }
    }
}

// One of the ways in which a triangle says nothing, or too much.
float odd_number(test::Chance& chance) {
    constexpr std::array<float, 8> numbers{0.0F,    1.0F,  -1.0F,  1e-20F,
                                           -1e-20F, 1e20F, -1e20F, 1e-38F};
    return numbers[static_cast<std::size_t>(chance.whole(0, 7))];
}

TEST(TangentFrames, OfDegenerateTrianglesAreOrthonormalAndFinite) {
    test::Chance chance(12);
    for (int i = 0; i < 20000; ++i) {
        std::array<glm::vec3, 3> corners{};
        std::array<glm::vec2, 3> coordinates{};
        for (std::size_t k = 0; k < 3; ++k) {
            corners[k] = {odd_number(chance), odd_number(chance), odd_number(chance)};
            coordinates[k] = {odd_number(chance), odd_number(chance)};
        }
        const Mesh mesh = triangle(corners, coordinates, direction(chance));
        expect_orthonormal(mesh, tangent_frames(mesh));
    }
}

TEST(TangentFrames, NotANumberInOneTriangleLeavesTheOthersAlone) {
    Mesh mesh = plane_mesh({1.0F, 1.0F});
    const float nan = std::numeric_limits<float>::quiet_NaN();
    mesh.positions.emplace_back(nan);
    mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
    mesh.texture_coordinates.emplace_back(nan);
    mesh.indices.insert(mesh.indices.end(), {0, 1, 4});
    const auto frames = tangent_frames(mesh);
    expect_orthonormal(mesh, frames);
    EXPECT_EQ(frames[0].tangent, glm::vec3(1.0F, 0.0F, 0.0F));
}

TEST(TangentFrames, AScaledMeshHasTheSameDirections) {
    for (const float scale : {1e-18F, 1e-6F, 1e6F, 1e18F}) {
        Mesh mesh = sphere_mesh(1.0F, 12);
        const auto before = tangent_frames(mesh);
        for (glm::vec3& position : mesh.positions) {
            position *= scale;
        }
        const auto after = tangent_frames(mesh);
        expect_orthonormal(mesh, after);
        for (std::size_t i = 0; i < after.size(); ++i) {
            ASSERT_LT(glm::distance(before[i].tangent, after[i].tangent), 1e-4F);
            ASSERT_NEAR(after[i].density.x * scale, before[i].density.x,
                        1e-3F * before[i].density.x);
        }
    }
}

// Around the axis to the east, downwards from pole to pole: nowhere mirrored.
TEST(TangentFrames, OfASphereRunEastAndSouth) {
    const Mesh mesh = sphere_mesh(3.0F, 48);
    const auto frames = tangent_frames(mesh);
    expect_orthonormal(mesh, frames);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const glm::vec3 normal = mesh.normals[i];
        if (std::abs(normal.z) > 0.95F) {
            continue;
        }
        const glm::vec3 east = glm::normalize(glm::cross(glm::vec3(0.0F, 0.0F, 1.0F), normal));
        EXPECT_GT(glm::dot(frames[i].tangent, east), 0.99F);
        EXPECT_GT(glm::dot(bitangent(frames[i], normal), glm::cross(east, normal)), 0.99F);
    }
}

TEST(TangentFrames, OfEveryShapeAreThoseOfAnUprightPicture) {
    for (const Mesh& mesh :
         {plane_mesh({2.0F, 3.0F}), box_mesh({1.0F, 2.0F, 3.0F}), sphere_mesh(1.0F),
          torus_mesh(2.0F, 0.5F), cylinder_mesh(1.0F, 2.0F)}) {
        const auto frames = tangent_frames(mesh);
        expect_orthonormal(mesh, frames);
        int unknown = 0; // the last one at a pole, whose triangles have no area
        for (std::size_t i = 0; i < frames.size(); ++i) {
            if (frames[i].density.x == 0.0F) {
                ASSERT_LE(++unknown, 2);
                continue;
            }
            ASSERT_EQ(frames[i].handedness, -1.0F);
            // On walls that look outwards the picture's columns run downwards.
            const bool outwards =
                glm::dot(glm::vec2(mesh.normals[i]), glm::vec2(mesh.positions[i])) > 0.0F;
            if (outwards && std::abs(mesh.normals[i].z) < 1e-6F) {
                ASSERT_LE(bitangent(frames[i], mesh.normals[i]).z, 1e-5F);
            }
        }
    }
}

} // namespace
} // namespace reljef::scene
