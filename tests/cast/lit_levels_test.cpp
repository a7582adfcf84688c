#include "engine/cast/lit_levels.h"

#include <algorithm>
#include <cstdint>

#include <gtest/gtest.h>

namespace reljef::cast {
namespace {

constexpr glm::ivec2 map_size{13, 6};

std::uint32_t texel(const TilePaint& paint, int level, glm::ivec2 place) {
    const int stride = (paint.last.x >> level) + 2;
    return paint.texels[paint.begin[static_cast<std::size_t>(level)] + place.y * stride + place.x];
}

TEST(LitLevels, TheLastLevelIsOneTexel) {
    const LitLevels levels(Image(map_size.x, map_size.y, Rgba8{50, 100, 200, 255}), map_size);
    const TilePaint paint = levels.paint();
    ASSERT_EQ(paint.level_count, 5); // 13, 7, 4, 2, 1 columns
    EXPECT_EQ(paint.last >> (paint.level_count - 1), glm::ivec2(0));
    EXPECT_EQ(paint.begin[5], paint.begin[4]);
}

TEST(LitLevels, OneColourIsTheSameOnAllLevelsAndBesideTheMap) {
    const LitLevels levels(Image(map_size.x, map_size.y, Rgba8{50, 100, 200, 255}), map_size);
    const TilePaint paint = levels.paint();
    for (int level = 0; level < paint.level_count; ++level) {
        const glm::ivec2 beside = (paint.last >> level) + 1;
        for (int row = 0; row <= beside.y; ++row) {
            for (int col = 0; col <= beside.x; ++col) {
                ASSERT_EQ(texel(paint, level, {col, row}), texel(paint, 0, {0, 0}))
                    << level << ": " << col << ", " << row;
            }
        }
    }
}

TEST(LitLevels, ATexelIsTheMeanOfTheLightOfFour) {
    Image lit(4, 4, Rgba8{0, 0, 0, 255});
    lit(2, 1) = {255, 255, 255, 255};
    const LitLevels levels(lit, {4, 4});
    const TilePaint paint = levels.paint();
    constexpr std::uint32_t half = 512; // the root of 1/4, of 1023
    EXPECT_EQ(texel(paint, 1, {1, 0}), half | half << 10U | half << 20U);
    EXPECT_EQ(texel(paint, 1, {0, 0}), 0U);
    constexpr std::uint32_t quarter = 256;
    EXPECT_EQ(texel(paint, 2, {0, 0}), quarter | quarter << 10U | quarter << 20U);
}

// Near poles, columns are much closer than rows.
TEST(LitLevels, TheLongerSideOfTexelsLimitsTheirLevel) {
    const LitLevels levels(Image(map_size.x, map_size.y, Rgba8{50, 100, 200, 255}), map_size);
    view::DrawList list;
    list.size = {640, 480};
    const TilePaint paint = levels.paint();
    const float square = longest_texels(list, paint, {20.0, 20.0}).y;
    EXPECT_GT(square, 0.0F);
    EXPECT_EQ(longest_texels(list, paint, {1.0, 20.0}).y, square);
    EXPECT_EQ(longest_texels(list, paint, {20.0, 1.0}).y, square);
}

} // namespace
} // namespace reljef::cast
