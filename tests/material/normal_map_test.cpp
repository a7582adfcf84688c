#include "engine/material/normal_map.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::terrain {
namespace {

using test::Chance;

constexpr double float_rounding = 0x1p-20; // a few of a unit vector's

TEST(NormalMap, APlaneHasItsNormalWhateverTheFilter) {
    Chance chance(1);
    for (int i = 0; i < 300; ++i) {
        const glm::dvec2 rise{chance.between(-2.0, 2.0), chance.between(-2.0, 2.0)};
        const glm::dvec2 spacing{chance.between(0.1, 30.0), chance.between(0.1, 30.0)};
        const auto heights =
            test::made_heights(7, 6, [&](int col, int row) { return rise.x * col + rise.y * row; });
        const glm::dvec3 expected =
            glm::normalize(glm::dvec3(-rise.x / spacing.x, rise.y / spacing.y, 1.0));
        for (const material::NormalFilter filter :
             {material::NormalFilter::bilinear, material::NormalFilter::sobel}) {
            const auto normals = material::normals_from_heights(
                heights.view(), {.spacing = spacing, .filter = filter});
            EXPECT_LE(glm::distance(glm::dvec3(normals(3, 2)), expected), 8.0 * float_rounding);
        }
    }
}

TEST(NormalMap, AtASampleItIsTheMeanOfTheFourCellsGradients) {
    Chance chance(2);
    const Grid<float> heights = test::random_heights(20, 20, 0.0F, 3.0F, 2);
    const auto normals = material::normals_from_heights(heights.view());
    for (int i = 0; i < 500; ++i) {
        const glm::ivec2 at(chance.whole(1, 18), chance.whole(1, 18));
        const auto height = [&](int col, int row) {
            return static_cast<double>(heights(at.x + col, at.y + row));
        };
        const glm::dvec2 slope(0.5 * (height(-1, 0) - height(1, 0)),
                               0.5 * (height(0, 1) - height(0, -1)));
        const glm::dvec3 normal(normals(at.x, at.y));
        EXPECT_NEAR(normal.x / normal.z, slope.x, 1e-5);
        EXPECT_NEAR(normal.y / normal.z, slope.y, 1e-5);
    }
}

TEST(NormalMap, WrappedItDoesNotSeeTheBorder) {
    const Grid<float> heights = test::random_heights(9, 8, 0.0F, 3.0F, 3);
    for (const material::NormalFilter filter :
         {material::NormalFilter::bilinear, material::NormalFilter::sobel}) {
        const material::NormalOptions options{.filter = filter, .border = material::WrapMode::wrap};
        const auto normals = material::normals_from_heights(heights.view(), options);
        const auto moved = test::made_heights(
            9, 8, [&](int col, int row) { return heights((col + 4) % 9, (row + 5) % 8); });
        const auto moved_normals = material::normals_from_heights(moved.view(), options);
        for (int row = 0; row < 8; ++row) {
            for (int col = 0; col < 9; ++col) {
                EXPECT_EQ(moved_normals(col, row), normals((col + 4) % 9, (row + 5) % 8));
            }
        }
    }
}

TEST(NormalMap, OneSampleAndOneRowAreLevelAcross) {
    EXPECT_EQ(material::normals_from_heights(Grid<float>(1, 1, 5.0F).view())(0, 0),
              glm::vec3(0.0F, 0.0F, 1.0F));
    const auto row = test::made_heights(5, 1, [](int col, int) { return 2.0 * col; });
    EXPECT_EQ(material::normals_from_heights(row.view())(2, 0).y, 0.0F);
}

} // namespace
} // namespace reljef::terrain
