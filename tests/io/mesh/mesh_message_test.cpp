#include "engine/io/mesh/mesh_message.h"

#include <limits>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace reljef::io {
namespace {

std::vector<MeshPart> box_parts() {
    MeshPart part;
    part.mesh = scene::box_mesh({1.0F, 2.0F, 3.0F});
    part.color = {0.25F, 0.5F, 0.75F};
    part.texture = "wall.png";
    part.picture = {std::byte{1}, std::byte{2}};
    return {part, part};
}

Result<std::vector<MeshPart>> decoded(const std::vector<MeshPart>& parts) {
    return decoded_parts(encoded_parts(parts));
}

TEST(MeshMessage, GivesTheSamePartsBack) {
    const std::vector<MeshPart> parts = box_parts();
    const auto found = decoded(parts);
    ASSERT_TRUE(found);
    ASSERT_EQ(found->size(), 2U);
    EXPECT_EQ((*found)[1].mesh.positions, parts[1].mesh.positions);
    EXPECT_EQ((*found)[1].mesh.normals, parts[1].mesh.normals);
    EXPECT_EQ((*found)[1].mesh.texture_coordinates, parts[1].mesh.texture_coordinates);
    EXPECT_EQ((*found)[1].mesh.indices, parts[1].mesh.indices);
    EXPECT_EQ((*found)[1].color, parts[1].color);
    EXPECT_EQ((*found)[1].texture, "wall.png");
    EXPECT_EQ((*found)[1].picture, parts[1].picture);
}

TEST(MeshMessage, FailsWhereverItIsCutOffOrLonger) {
    std::vector<std::byte> bytes = encoded_parts(box_parts());
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        ASSERT_FALSE(decoded_parts(std::span(bytes).first(size))) << size;
    }
    bytes.push_back({});
    EXPECT_FALSE(decoded_parts(bytes));
}

TEST(MeshMessage, TrustsNoSize) {
    const std::vector<std::byte> good = encoded_parts(box_parts());
    for (std::size_t i = 0; i < good.size(); ++i) {
        std::vector<std::byte> bytes = good;
        bytes[i] = std::byte{0xff};
        const auto found = decoded_parts(bytes); // an error or a mesh in reach
        for (const MeshPart& part : found ? *found : std::vector<MeshPart>()) {
            ASSERT_LE(part.mesh.indices.size(), good.size());
        }
    }
}

TEST(MeshMessage, RefusesIndicesAndPlacesOutOfReach) {
    std::vector<MeshPart> parts = box_parts();
    parts[0].mesh.indices[5] = 24;
    EXPECT_FALSE(decoded(parts));
    parts = box_parts();
    parts[0].mesh.indices.pop_back();
    EXPECT_FALSE(decoded(parts));
    for (const float wrong : {2.0F * max_mesh_coordinate, std::numeric_limits<float>::infinity(),
                              std::numeric_limits<float>::quiet_NaN()}) {
        parts = box_parts();
        parts[1].mesh.positions[3].y = wrong;
        const auto refused = decoded(parts);
        ASSERT_FALSE(refused);
        EXPECT_THAT(refused.error().message, testing::HasSubstr("100000 m from its origin"));
    }
}

TEST(MeshMessage, ComputesMissingNormalsAndCoordinates) {
    std::vector<MeshPart> parts = box_parts();
    const std::vector<glm::vec3> normals = parts[0].mesh.normals;
    parts[0].mesh.normals.clear();
    parts[0].mesh.texture_coordinates.clear();
    parts[1].mesh.normals[7] = glm::vec3(std::numeric_limits<float>::quiet_NaN());
    parts[1].mesh.texture_coordinates[7].x = std::numeric_limits<float>::infinity();
    parts[1].color.g = std::numeric_limits<float>::quiet_NaN();
    const auto found = decoded(parts);
    ASSERT_TRUE(found);
    for (const MeshPart& part : *found) {
        ASSERT_EQ(part.mesh.normals.size(), normals.size());
        for (std::size_t i = 0; i < normals.size(); ++i) {
            EXPECT_LT(glm::distance(part.mesh.normals[i], normals[i]), 1e-6F) << i;
        }
        EXPECT_EQ(part.mesh.texture_coordinates.size(), normals.size());
    }
    EXPECT_EQ((*found)[0].mesh.texture_coordinates[7], glm::vec2(0.0F));
    EXPECT_EQ((*found)[1].mesh.texture_coordinates[7], glm::vec2(0.0F));
    EXPECT_EQ((*found)[1].color, glm::vec3(0.8F));
}

} // namespace
} // namespace reljef::io
