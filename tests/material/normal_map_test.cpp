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
        EXPECT_LE(
            glm::distance(material::bilinear_normal(heights.view(), {2.3, 4.9}, spacing), expected),
            64.0 * float_rounding);
    }
}

TEST(NormalMap, AtASampleItIsTheMeanOfTheFourCellsGradients) {
    Chance chance(2);
    const Grid<float> heights = test::random_heights(20, 20, 0.0F, 3.0F, 2);
    const auto normals = material::normals_from_heights(heights.view());
    for (int i = 0; i < 500; ++i) {
        const glm::ivec2 at(chance.whole(1, 18), chance.whole(1, 18));
        glm::dvec2 slope(0.0);
        for (const glm::dvec2 way : {glm::dvec2(-1.0, -1.0), glm::dvec2(1.0, -1.0),
                                     glm::dvec2(-1.0, 1.0), glm::dvec2(1.0, 1.0)}) {
            const glm::dvec3 beside =
                material::bilinear_normal(heights.view(), glm::dvec2(at) + 1e-9 * way, {1.0, 1.0});
            slope += 0.25 * glm::dvec2(beside) / beside.z;
        }
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

TEST(NormalMap, AsAPictureItComesBackWithinItsQuantum) {
    const Grid<float> heights = test::random_heights(30, 20, 0.0F, 1.0F, 4);
    const auto normals = material::normals_from_heights(heights.view());
    const Image image = material::normal_image(normals.view(), heights.view());
    const material::ReadNormals read = material::normals_from_image(image);
    EXPECT_EQ(read.unusable, 0U);
    for (std::size_t i = 0; i < normals.size(); ++i) {
        // Each part is off by half of 2/255, and the length that is set right by as much again.
        EXPECT_LE(glm::distance(read.normals.samples()[i], normals.samples()[i]),
                  std::sqrt(3.0F) * 2.0F / 255.0F);
        EXPECT_NEAR(image.samples()[i].a / 255.0, heights.samples()[i], 0.5 / 255.0 + 1e-6);
    }
}

TEST(NormalMap, NormalsThatAreNoneAreLevelAndCounted) {
    Image image(3, 1, Rgba8{128, 128, 255, 255});
    image(1, 0) = {127, 127, 127, 255};
    image(2, 0) = {255, 0, 0, 255};
    const material::ReadNormals read = material::normals_from_image(image);
    EXPECT_EQ(read.unusable, 2U);
    EXPECT_EQ(read.normals(1, 0), glm::vec3(0.0F, 0.0F, 1.0F));
    EXPECT_EQ(read.normals(2, 0), glm::vec3(0.0F, 0.0F, 1.0F));
}

} // namespace
} // namespace reljef::terrain
