#include "engine/material/color_relief.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/terrain/chance.h"

namespace reljef::terrain {
namespace {

Rgba8 grey_of(double value) {
    const auto byte = static_cast<std::uint8_t>(std::lround(value));
    return {byte, byte, byte, 255};
}

Image made_picture(int cols, int rows, const auto& value) {
    Image image(cols, rows);
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
            image(col, row) = grey_of(value(col, row));
        }
    }
    return image;
}

TEST(ColorRelief, WithoutContrastThereIsNoRelief) {
    for (const int level : {0, 1, 93, 128, 254, 255}) {
        const auto heights =
            material::heights_from_colors(made_picture(30, 20, [&](int, int) { return level; }));
        for (const float height : heights.samples()) {
            EXPECT_EQ(height, 0.0F);
        }
    }
    EXPECT_TRUE(material::heights_from_colors({}).empty());
    EXPECT_EQ(material::heights_from_colors(Image(1, 1)).size(), 1U);
}

TEST(ColorRelief, BrightIsHighOrTheOtherWayRound) {
    const Image bricks = made_picture(
        64, 64, [](int col, int row) { return col % 16 < 2 || row % 8 < 2 ? 60.0 : 180.0; });
    const auto heights = material::heights_from_colors(bricks);
    EXPECT_GT(heights(24, 28), heights(17, 28) + 0.5F);
    const auto turned = material::heights_from_colors(bricks, {.dark_is_high = true});
    EXPECT_LT(turned(24, 28), turned(17, 28) - 0.5F);
    for (const float height : heights.samples()) {
        EXPECT_TRUE(height >= 0.0F && height <= 1.0F);
    }
}

TEST(ColorRelief, AShadeOverTheWholePictureIsNoRelief) {
    const Image shaded = made_picture(
        512, 64, [](int col, int) { return 100.0 + 0.2 * col + (col % 16 < 8 ? 20.0 : 0.0); });
    const auto heights = material::heights_from_colors(shaded, {.octaves = 3});
    EXPECT_NEAR(heights(132, 30), heights(404, 30), 0.2F);
}

} // namespace
} // namespace reljef::terrain
