#include "engine/material/relief_material.h"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/terrain/chance.h"

namespace reljef::terrain {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

material::ReliefMaterial level_set(int cols = 8, int rows = 8) {
    material::ReliefMaterial set;
    set.name = "made";
    set.color = Image(cols, rows);
    set.heights = Grid<float>(cols, rows, 0.5F);
    return set;
}

std::string error_of(material::ReliefMaterial set) {
    const auto done = material::completed(std::move(set), material::WrapMode::wrap);
    EXPECT_FALSE(done);
    return done ? "" : done.error().message;
}

TEST(TileNormals, AreThoseOfARampExactly) {
    Grid<float> ramp(16, 8);
    for (int row = 0; row < ramp.rows(); ++row) {
        for (int col = 0; col < ramp.cols(); ++col) {
            ramp(col, row) = 0.03125F * static_cast<float>(col) + 0.0625F * static_cast<float>(row);
        }
    }
    const auto normals = material::tile_normals(ramp.view(), 0.25F, material::WrapMode::clamp);
    // Rises by 16/32 over the tile's width and by 8/16 over its height, times the scale.
    const glm::vec3 expected = glm::normalize(glm::vec3(-0.125F, -0.125F, 1.0F));
    for (int row = 1; row + 1 < ramp.rows(); ++row) {
        for (int col = 1; col + 1 < ramp.cols(); ++col) {
            ASSERT_LT(glm::distance(normals(col, row), expected), 1e-6F);
        }
    }
}

TEST(TileNormals, AreTheMeanOfTheSlopesOnBothSidesOverTheBorderToo) {
    test::Chance chance(5);
    Grid<float> heights(9, 7);
    for (float& height : heights.samples()) {
        height = static_cast<float>(chance.between(0.0, 1.0));
    }
    const auto normals = material::tile_normals(heights.view(), 0.5F, material::WrapMode::wrap);
    for (int row = 0; row < 7; ++row) {
        for (int col = 0; col < 9; ++col) {
            const double before = heights(col, row) - heights((col + 8) % 9, row);
            const double after = heights((col + 1) % 9, row) - heights(col, row);
            const double slope = 0.5 * (before + after) * 9.0 * 0.5;
            ASSERT_NEAR(-normals(col, row).x / normals(col, row).z, slope, 1e-5);
        }
    }
}

TEST(ReliefMaterial, MakesNormalsWhereThereAreNone) {
    const auto set = material::completed(level_set(), material::WrapMode::wrap);
    ASSERT_TRUE(set);
    EXPECT_EQ(set->normals(3, 3), glm::vec3(0.0F, 0.0F, 1.0F));
    EXPECT_THAT(set->notes, IsEmpty());
}

TEST(ReliefMaterial, NormalsThatAreNoneStandUprightAndAreTold) {
    material::ReliefMaterial set = level_set();
    set.normals = Grid<glm::vec3>(8, 8, glm::vec3(0.0F, 0.6F, 0.8F));
    set.normals(1, 2) = glm::vec3(0.0F);
    set.normals(3, 4) = glm::vec3(0.0F, 0.0F, -1.0F);
    set.normals(5, 6) = glm::vec3(std::numeric_limits<float>::quiet_NaN());
    const auto done = material::completed(std::move(set), material::WrapMode::wrap);
    ASSERT_TRUE(done);
    EXPECT_EQ(done->normals(1, 2), glm::vec3(0.0F, 0.0F, 1.0F));
    EXPECT_EQ(done->normals(3, 4), glm::vec3(0.0F, 0.0F, 1.0F));
    EXPECT_EQ(done->normals(5, 6), glm::vec3(0.0F, 0.0F, 1.0F));
    EXPECT_LT(glm::distance(done->normals(0, 0), glm::vec3(0.0F, 0.6F, 0.8F)), 1e-6F);
    EXPECT_THAT(done->notes, ElementsAre(HasSubstr("3 of 64 normals")));
}

TEST(ReliefMaterial, MapsOfDifferentSizesAreTold) {
    material::ReliefMaterial set = level_set(8, 4);
    set.color = Image(16, 4);
    const auto done = material::completed(std::move(set), material::WrapMode::wrap);
    ASSERT_TRUE(done);
    EXPECT_THAT(done->notes,
                ElementsAre(AllOf(HasSubstr("colours of 16 x 4"), HasSubstr("heights of 8 x 4"))));
}

TEST(ReliefMaterial, ASeamIsToldOnlyWhereTheTileIsToRepeat) {
    for (const bool along_rows : {false, true}) {
        material::ReliefMaterial set = level_set(32, 32);
        for (int row = 0; row < 32; ++row) {
            for (int col = 0; col < 32; ++col) {
                set.heights(col, row) = static_cast<float>(along_rows ? row : col) / 31.0F;
            }
        }
        EXPECT_TRUE(material::has_seam(set.heights.view()));
        EXPECT_THAT(material::completed(set, material::WrapMode::wrap)->notes,
                    ElementsAre(HasSubstr("do not fit together")));
        EXPECT_THAT(material::completed(set, material::WrapMode::clamp)->notes, IsEmpty());
    }
    Grid<float> waves(32, 32);
    for (int row = 0; row < 32; ++row) {
        for (int col = 0; col < 32; ++col) {
            waves(col, row) = 0.5F + 0.4F * std::sin(0.19635F * static_cast<float>(col + 2 * row));
        }
    }
    EXPECT_FALSE(material::has_seam(waves.view()));
}

TEST(ReliefMaterial, WhatIsMissingOrOutOfRangeIsOneSentence) {
    material::ReliefMaterial set = level_set();
    set.color = {};
    EXPECT_THAT(error_of(set), AllOf(HasSubstr("texture set made"), HasSubstr("no colours")));
    set = level_set();
    set.heights = {};
    EXPECT_THAT(error_of(set), HasSubstr("no heights found, a map of heights was expected"));
    for (const float height : {-0.01F, 1.01F, std::numeric_limits<float>::quiet_NaN(),
                               std::numeric_limits<float>::infinity()}) {
        set = level_set();
        set.heights(3, 3) = height;
        EXPECT_THAT(error_of(set), HasSubstr("heights in [0, 1] were expected"));
    }
    for (const float scale : {0.0F, -1.0F, std::numeric_limits<float>::infinity()}) {
        set = level_set();
        set.scale = scale;
        EXPECT_THAT(error_of(set), HasSubstr("a number above 0 was expected"));
    }
}

} // namespace
} // namespace reljef::terrain
