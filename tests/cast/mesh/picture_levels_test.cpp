#include "engine/cast/mesh/picture_levels.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace reljef::cast {
namespace {

Image speckled(int cols, int rows) {
    Image picture(cols, rows);
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
            picture(col, row) = {static_cast<std::uint8_t>((37 * col + 11 * row) % 256),
                                 static_cast<std::uint8_t>((col * row) % 256), 90, 255};
        }
    }
    return picture;
}

glm::vec3 mean_of(const Image& picture) {
    glm::vec3 sum(0.0F);
    for (const Rgba8 texel : picture.samples()) {
        sum += linear_from_rgba8(texel);
    }
    return sum / static_cast<float>(picture.size());
}

TEST(PictureLevels, AreThePictureNearby) {
    const Image picture = speckled(7, 5);
    const PictureLevels levels(picture);
    const glm::dvec2 still(0.0);
    for (int row = 0; row < 5; ++row) {
        for (int col = 0; col < 7; ++col) {
            const glm::dvec2 middle((col + 0.5) / 7.0, (row + 0.5) / 5.0);
            const glm::vec3 color = linear_from_rgba8(picture(col, row));
            EXPECT_LT(glm::distance(levels.at(middle, still, still), color), 1e-5F);
            EXPECT_LT(glm::distance(levels.at(middle - 3.0, still, still), color), 1e-5F);
            const glm::dvec2 right((col + 1.0) / 7.0, (row + 0.5) / 5.0);
            const glm::vec3 next = linear_from_rgba8(picture((col + 1) % 7, row));
            EXPECT_LT(glm::distance(levels.at(right, still, still), 0.5F * (color + next)), 1e-5F);
        }
    }
}

// Texels of any number of rows and columns weigh the same.
TEST(PictureLevels, AreTheMeanFarAway) {
    for (const glm::ivec2 size : {glm::ivec2(64, 64), glm::ivec2(7, 5), glm::ivec2(1, 13)}) {
        const Image picture = speckled(size.x, size.y);
        const PictureLevels levels(picture);
        const glm::vec3 far = levels.at({0.3, 0.6}, {1.0, 0.0}, {0.0, 1.0});
        EXPECT_LT(glm::distance(far, mean_of(picture)), 0.01F) << size.x;
        const glm::vec3 endless = levels.at({0.3, 0.6}, {1e30, 0.0}, {0.0, 1e30});
        EXPECT_EQ(far, endless) << size.x;
    }
}

TEST(PictureLevels, WeighAllTexelsTheSame) {
    for (int col = 0; col < 7; ++col) {
        Image picture(7, 1, Rgba8{0, 0, 0, 255});
        picture(col, 0) = {255, 255, 255, 255};
        const PictureLevels levels(picture);
        EXPECT_NEAR(levels.at({0.5, 0.5}, {1.0, 0.0}, {0.0, 1.0}).r, 1.0 / 7.0, 0.01) << col;
    }
}

// A pixel that is 2 texels wide takes level 1, and at most 8 times its short side.
TEST(PictureLevels, FollowThePixel) {
    Image stripes(64, 64, Rgba8{255, 255, 255, 255});
    for (int row = 0; row < 64; ++row) {
        for (int col = 0; col < 64; col += 2) {
            stripes(col, row) = {0, 0, 0, 255};
        }
    }
    const PictureLevels levels(stripes);
    const glm::dvec2 on_stripe(10.5 / 64.0, 0.5);
    const double texel = 1.0 / 64.0;
    EXPECT_LT(levels.at(on_stripe, {texel, 0.0}, {0.0, texel}).r, 0.01F);
    EXPECT_NEAR(levels.at(on_stripe, {2.0 * texel, 0.0}, {0.0, 2.0 * texel}).r, 0.5F, 0.01F);
    EXPECT_LT(levels.at(on_stripe, {8.0 * texel, 0.0}, {0.0, texel / 16.0}).r, 0.01F);
}

} // namespace
} // namespace reljef::cast
