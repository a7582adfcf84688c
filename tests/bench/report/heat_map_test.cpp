#include "bench/report/row_view.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace reljef::bench {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float none = std::numeric_limits<float>::quiet_NaN();

// Oklab's lightness (Ottosson 2020), from linear r, g, b.
float lightness_of(Rgba8 color) {
    const glm::vec3 rgb = linear_from_rgba8(color);
    const float l = 0.4122214708F * rgb.r + 0.5363325363F * rgb.g + 0.0514459929F * rgb.b;
    const float m = 0.2119034982F * rgb.r + 0.6806995451F * rgb.g + 0.1073969566F * rgb.b;
    const float s = 0.0883024619F * rgb.r + 0.2817188376F * rgb.g + 0.6299787005F * rgb.b;
    return 0.2104542553F * std::cbrt(l) + 0.7936177850F * std::cbrt(m) -
           0.0040720468F * std::cbrt(s);
}

Rgba8 color_of(float error_px) {
    return heat_map(Grid<float>(1, 1, error_px))(0, 0);
}

TEST(HeatScale, lightness_grows_evenly) {
    const auto scale = heat_scale();
    const float step = (lightness_of(scale.back()) - lightness_of(scale.front())) /
                       static_cast<float>(heat_levels - 1);
    EXPECT_GT(step, 0.01F);
    for (std::size_t i = 1; i < heat_levels; ++i) {
        EXPECT_NEAR(lightness_of(scale[i]) - lightness_of(scale[i - 1]), step, 0.5F * step) << i;
    }
}

TEST(HeatScale, has_no_colour_like_that_of_no_bound) {
    for (const Rgba8 color : heat_scale()) {
        EXPECT_GT(std::abs(color.r - heat_unbounded.r) + std::abs(color.g - heat_unbounded.g) +
                      std::abs(color.b - heat_unbounded.b),
                  200);
    }
}

TEST(HeatMap, ends_of_the_scale_hold_what_lies_beyond) {
    const auto scale = heat_scale();
    for (const float low : {0.0F, 1e-30F, 0.009F, 0.01F}) {
        EXPECT_EQ(color_of(low), scale.front()) << low;
    }
    for (const float high : {100.0F, 101.0F, 3e38F}) {
        EXPECT_EQ(color_of(high), scale.back()) << high;
    }
}

TEST(HeatMap, tenfolds_take_equal_shares) {
    const auto scale = heat_scale();
    for (int tenfold = 0; tenfold < 4; ++tenfold) {
        const float begin = 0.01F * std::pow(10.0F, static_cast<float>(tenfold));
        EXPECT_EQ(color_of(begin * 1.01F), scale.at(static_cast<std::size_t>(16 * tenfold)));
        EXPECT_EQ(color_of(begin * 9.9F), scale.at(static_cast<std::size_t>(16 * tenfold + 15)));
    }
}

TEST(HeatMap, greater_errors_are_never_darker) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> exponent(-4.0F, 4.0F);
    for (int i = 0; i < 5000; ++i) {
        const float a = std::pow(10.0F, exponent(random));
        const float b = std::pow(10.0F, exponent(random));
        EXPECT_LE(lightness_of(color_of(std::min(a, b))), lightness_of(color_of(std::max(a, b))));
    }
}

TEST(HeatMap, no_bound_and_no_error_have_marks_of_their_own) {
    EXPECT_EQ(color_of(infinite), heat_unbounded);
    const Image hatch = heat_map(Grid<float>(16, 16, none));
    int lines = 0;
    for (const Rgba8 pixel : hatch.samples()) {
        EXPECT_LT(std::abs(pixel.r - pixel.b), 8); // grey, unlike the scale
        lines += pixel == hatch(0, 0) ? 1 : 0;
    }
    EXPECT_EQ(lines, 64); // a quarter of it
}

TEST(HeatMap, every_pixel_stays_at_its_place) {
    Grid<float> error(5, 3, 0.0F);
    error(4, 1) = infinite;
    const Image map = heat_map(error);
    ASSERT_EQ(map.cols(), 5);
    ASSERT_EQ(map.rows(), 3);
    for (int row = 0; row < 3; ++row) {
        for (int col = 0; col < 5; ++col) {
            EXPECT_EQ(map(col, row) == heat_unbounded, col == 4 && row == 1);
        }
    }
    EXPECT_TRUE(heat_map(Grid<float>()).empty());
}

TEST(HeatMapDeathTest, negative_error_is_refused) {
    EXPECT_DEATH(static_cast<void>(heat_map(Grid<float>(1, 1, -1.0F))), "negative error");
}

} // namespace
} // namespace reljef::bench
