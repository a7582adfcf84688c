#include "engine/material/layer_map.h"

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/material/relief_material.h"
#include "tests/terrain/chance.h"

namespace reljef::terrain {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string refusal_of(Grid<glm::vec4> heights) {
    const auto made = material::LayerMap::create(std::move(heights));
    EXPECT_FALSE(made);
    return made ? "" : made.error().message;
}

TEST(LayerMap, LayersOutOfOrderAreToldWithTheFirstPlace) {
    Grid<glm::vec4> heights(5, 4, glm::vec4(0.9F, 0.6F, 0.6F, 0.1F));
    EXPECT_TRUE(material::LayerMap::create(heights));
    heights(2, 3).w = 0.7F;
    heights(3, 1).y = 0.95F;
    EXPECT_THAT(refusal_of(heights),
                AllOf(HasSubstr("column 3, row 1"), HasSubstr("layer 2 at 0.95 above layer 1"),
                      HasSubstr("was expected")));
    heights(3, 1).y = std::nanf("");
    EXPECT_THAT(refusal_of(heights), AllOf(HasSubstr("column 3, row 1"), HasSubstr("in layer 2")));
    heights(0, 0).x = 1.5F;
    EXPECT_THAT(refusal_of(heights), HasSubstr("column 0, row 0 a height of 1.5"));
    EXPECT_THAT(refusal_of({}), HasSubstr("no texels"));
}

Grid<float> any_heights(int cols, int rows, test::Chance& chance) {
    Grid<float> heights(cols, rows);
    for (float& height : heights.samples()) {
        height = static_cast<float>(chance.between(0.0, 1.0));
    }
    return heights;
}

TEST(LayerMap, ASymmetricSheetIsItsOwnBack) {
    test::Chance chance(1);
    Grid<float> heights = any_heights(9, 7, chance);
    heights(4, 4) = 0.0F;
    const material::LayerMap front = material::symmetric_layers(heights.view());
    const material::LayerMap back = material::seen_from_behind(material::seen_from_behind(front));
    for (std::size_t i = 0; i < heights.size(); ++i) {
        const glm::vec4 layers = front.heights().samples()[i];
        EXPECT_NEAR(layers.x - layers.y, heights.samples()[i], 1e-6F);
        EXPECT_FLOAT_EQ(layers.x + layers.y, 1.0F);
        EXPECT_EQ(layers.z, layers.w);
        EXPECT_LT(glm::distance(layers, back.heights().samples()[i]), 1e-6F);
    }
    EXPECT_EQ(front.heights()(4, 4).x, front.heights()(4, 4).y);
}

TEST(LayerMap, TheTwoSidesOfASheetAreOfOneSize) {
    const Grid<float> front(4, 4, 1.0F);
    const Grid<float> back(4, 5, 0.5F);
    EXPECT_THAT(material::dual_layers(front.view(), back.view()).error().message,
                AllOf(HasSubstr("4 x 4"), HasSubstr("4 x 5"), HasSubstr("one size")));
    const auto layers =
        material::dual_layers(front.view(), front.view().window(0, 0, 4, 4)).value();
    EXPECT_EQ(layers.heights()(1, 2), glm::vec4(1.0F, 0.0F, 0.0F, 0.0F));
}

// A ramp: one normal all over, known from its slope; it points off the solid.
TEST(LayerMap, NormalsPointOffTheSolidAndLeanAsTheLayersDo) {
    Grid<glm::vec4> heights(16, 8);
    for (int row = 0; row < 8; ++row) {
        for (int col = 0; col < 16; ++col) {
            const float rise = 0.01F * static_cast<float>(col) + 0.02F * static_cast<float>(row);
            heights(col, row) = {0.6F + rise, 0.5F - rise, 0.2F, 0.1F};
        }
    }
    const material::LayerNormals normals = material::layer_normals(
        material::LayerMap::create(heights).value(), 0.5F, material::WrapMode::clamp);
    // 0.01 a texel are 0.16 a tile's width, 0.02 are 0.16 a tile's height: times the scale.
    const glm::vec3 top = glm::normalize(glm::vec3(-0.08F, -0.08F, 1.0F));
    const glm::vec3 bottom = glm::normalize(glm::vec3(-0.08F, -0.08F, -1.0F));
    EXPECT_NEAR(normals.along_u(5, 4).x, top.x, 1e-6F);
    EXPECT_NEAR(normals.along_v(5, 4).x, top.y, 1e-6F);
    EXPECT_NEAR(normals.along_u(5, 4).y, bottom.x, 1e-6F);
    EXPECT_NEAR(normals.along_v(5, 4).y, bottom.y, 1e-6F);
    EXPECT_EQ(normals.along_u(5, 4).z, 0.0F);
}

// A box in tile space, from outside counter-clockwise: rows run down.
struct MadeMesh {
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> indices;

    void add_box(glm::vec3 low, glm::vec3 high) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        for (int i = 0; i < 8; ++i) {
            positions.emplace_back((i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y,
                                   (i & 4) != 0 ? high.z : low.z);
        }
        for (const int corner : {4, 6, 5, 5, 6, 7, 0, 1, 2, 1, 3, 2, 0, 2, 4, 4, 2, 6,
                                 1, 5, 3, 3, 5, 7, 0, 4, 1, 1, 4, 5, 2, 3, 6, 3, 7, 6}) {
            indices.push_back(first + static_cast<std::uint32_t>(corner));
        }
    }
    [[nodiscard]] material::TileMesh mesh() const { return {positions, indices}; }
};

// Both sides of a leaf at one height turn a plumb line in and out there, in any order.
TEST(LayersOfMesh, ALeafWithoutThicknessPullsNothingDown) {
    MadeMesh made;
    made.add_box({0.1F, 0.1F, 0.8F}, {0.9F, 0.9F, 0.9F});
    made.add_box({0.1F, 0.1F, 0.5F}, {0.9F, 0.9F, 0.5F});
    const auto layers = material::layers_of_mesh(made.mesh(), 20, 20);
    ASSERT_TRUE(layers) << layers.error().message;
    EXPECT_NEAR(layers->layers.heights()(10, 10).y, 0.8F, 1e-6F);
}

TEST(LayersOfMesh, PlacesThatAreNoNumbersAreTold) {
    for (const float bad : {std::nanf(""), 1e30F, -65.0F}) {
        MadeMesh made;
        made.add_box({0.1F, 0.1F, 0.2F}, {0.9F, 0.9F, 0.4F});
        made.positions[3].x = bad;
        EXPECT_THAT(material::layers_of_mesh(made.mesh(), 8, 8).error().message,
                    HasSubstr("vertex 3"));
    }
}

TEST(LayersOfMesh, AreTheBoxesThatStandOverEachOther) {
    MadeMesh made;
    made.add_box({0.1F, 0.1F, 0.6F}, {0.6F, 0.6F, 0.8F});
    made.add_box({0.4F, 0.4F, 0.1F}, {0.9F, 0.9F, 0.3F});
    const auto layers = material::layers_of_mesh(made.mesh(), 20, 20);
    ASSERT_TRUE(layers) << layers.error().message;
    EXPECT_EQ(layers->too_many, 0U);
    const auto near = [&](int col, int row, glm::vec4 expected) {
        EXPECT_LT(glm::distance(layers->layers.heights()(col, row), expected), 1e-6F)
            << col << ' ' << row;
    };
    near(5, 5, {0.8F, 0.6F, 0.2F, 0.2F});   // the upper alone
    near(10, 10, {0.8F, 0.6F, 0.3F, 0.1F}); // both
    const glm::vec4 alone = layers->layers.heights()(15, 15);
    EXPECT_LT(glm::distance(glm::vec2(alone), glm::vec2(0.3F, 0.1F)), 1e-6F);
    EXPECT_EQ(alone.z, alone.w);
    const glm::vec4 hole = layers->layers.heights()(19, 0);
    EXPECT_EQ(hole.x, hole.y);
    EXPECT_EQ(hole.z, hole.w);
}

TEST(LayersOfMesh, GoOnOverTheBorderAndCountWhatIsTooMuch) {
    MadeMesh made;
    made.add_box({0.8F, 0.2F, 0.1F}, {1.2F, 0.4F, 0.2F});
    made.add_box({-0.1F, 0.2F, 0.4F}, {0.1F, 0.4F, 0.5F});
    made.add_box({0.9F, 0.2F, 0.7F}, {0.95F, 0.4F, 0.9F});
    const auto layers = material::layers_of_mesh(made.mesh(), 40, 40);
    ASSERT_TRUE(layers);
    EXPECT_EQ(layers->too_many, 2U * 8U);
    EXPECT_LT(glm::distance(layers->layers.heights()(37, 10), glm::vec4(0.9F, 0.7F, 0.2F, 0.1F)),
              1e-6F);
    EXPECT_LT(glm::distance(layers->layers.heights()(2, 10), glm::vec4(0.5F, 0.4F, 0.2F, 0.1F)),
              1e-6F);
}

TEST(LayersOfMesh, ASphereIsAsThickAsItIsAndALowOneIsRefused) {
    MadeMesh made;
    constexpr int around = 96;
    constexpr int up = 48;
    const double turn = 2.0 * std::acos(-1.0);
    for (int row = 0; row <= up; ++row) {
        for (int col = 0; col < around; ++col) {
            const double angle = turn * col / around;
            const double rise = 0.5 * turn * row / up;
            made.positions.emplace_back(0.5 + 0.4 * std::sin(rise) * std::cos(angle) + 1e-4,
                                        0.5 + 0.4 * std::sin(rise) * std::sin(angle) + 2e-4,
                                        0.5 + 0.4 * std::cos(rise));
        }
    }
    for (int row = 0; row < up; ++row) {
        for (int col = 0; col < around; ++col) {
            const auto at = [&](int down, int right) {
                return static_cast<std::uint32_t>((row + down) * around + (col + right) % around);
            };
            made.indices.insert(made.indices.end(),
                                {at(0, 0), at(0, 1), at(1, 0), at(0, 1), at(1, 1), at(1, 0)});
        }
    }
    const auto layers = material::layers_of_mesh(made.mesh(), 64, 64);
    ASSERT_TRUE(layers) << layers.error().message;
    for (int row = 0; row < 64; ++row) {
        for (int col = 0; col < 64; ++col) {
            const double off = std::hypot((col + 0.5) / 64 - 0.5, (row + 0.5) / 64 - 0.5);
            const glm::vec4 at = layers->layers.heights()(col, row);
            const double expected = off < 0.4 ? 2.0 * std::sqrt(0.16 - off * off) : 0.0;
            ASSERT_NEAR(at.x - at.y, expected, off > 0.38 ? 0.15 : 0.004) << col << ' ' << row;
            ASSERT_NEAR(at.x + at.y, 1.0, 2e-3);
        }
    }
    for (glm::vec3& position : made.positions) {
        position.z -= 0.3F;
    }
    EXPECT_THAT(material::layers_of_mesh(made.mesh(), 16, 16).error().message,
                HasSubstr("in [0, 1]"));
}

TEST(LayersOfASet, FallBackToWhatItsHeightsSay) {
    test::Chance chance(2);
    material::ReliefMaterial set;
    set.color = Image(4, 4);
    set.heights = any_heights(4, 4, chance);
    set = material::completed(set, material::WrapMode::wrap).value();
    const float height = set.heights(1, 2);
    EXPECT_EQ(material::layers_of(set, material::LayerKind::multi).heights()(1, 2),
              glm::vec4(height, 0.0F, 0.0F, 0.0F));
    EXPECT_EQ(material::layers_of(set, material::LayerKind::dual).heights()(1, 2),
              glm::vec4(0.5F + 0.5F * height, 0.5F, 0.0F, 0.0F));
    set.back_heights = Grid<float>(3, 4, 0.5F);
    EXPECT_THAT(material::completed(set, material::WrapMode::wrap).error().message,
                HasSubstr("of the back of 3 x 4"));
}

} // namespace
} // namespace reljef::terrain
