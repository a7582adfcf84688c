#include "engine/core/color.h"

#include <bit>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace reljef {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

std::uint8_t byte(int value) {
    return static_cast<std::uint8_t>(value);
}

// Worked out in exact arithmetic from IEC 61966-2-1.
TEST(Color, MatchesKnownValuesOfTheStandard) {
    EXPECT_NEAR(srgb_from_linear(0.5F), 0.735357F, 1e-6F);
    EXPECT_NEAR(srgb_from_linear(0.18F), 0.461356F, 1e-6F);
    EXPECT_NEAR(srgb_from_linear(0.001F), 0.01292F, 1e-7F);
    EXPECT_NEAR(linear_from_srgb(0.5F), 0.214041F, 1e-6F);
    EXPECT_NEAR(linear_from_srgb(128.0F / 255.0F), 0.215861F, 1e-6F);
    EXPECT_NEAR(linear_from_srgb(0.04F), 0.00309598F, 1e-8F);
    EXPECT_EQ(rgba8_from_linear(glm::vec3(0.5F, 0.18F, 0.0F)), (Rgba8{188, 118, 0, 255}));
}

TEST(Color, EndsAreExact) {
    EXPECT_EQ(srgb_from_linear(0.0F), 0.0F);
    EXPECT_EQ(srgb_from_linear(1.0F), 1.0F);
    EXPECT_EQ(linear_from_srgb(0.0F), 0.0F);
    EXPECT_EQ(linear_from_srgb(1.0F), 1.0F);
}

TEST(Color, OutOfRangeIsClampedAndNanIsBlack) {
    EXPECT_EQ(srgb_from_linear(-1.0F), 0.0F);
    EXPECT_EQ(srgb_from_linear(2.0F), 1.0F);
    EXPECT_EQ(srgb_from_linear(infinity), 1.0F);
    EXPECT_EQ(srgb_from_linear(-infinity), 0.0F);
    EXPECT_EQ(srgb_from_linear(std::numeric_limits<float>::quiet_NaN()), 0.0F);
    EXPECT_EQ(rgba8_from_linear(glm::vec3(-4.0F, 4.0F, std::nanf("")), 7), (Rgba8{0, 255, 0, 7}));
}

TEST(Color, AllBytesSurviveTheRoundTripInEveryChannel) {
    for (int value = 0; value < 256; ++value) {
        const Rgba8 color{byte(value), byte(255 - value), byte((value * 7) % 256), byte(value)};
        EXPECT_EQ(rgba8_from_linear(linear_from_rgba8(color), color.a), color) << value;
    }
}

TEST(Color, EncodingInvertsDecodingAndBothGrow) {
    constexpr int steps = 20000;
    float last_linear = -1.0F;
    float last_encoded = -1.0F;
    for (int i = 0; i <= steps; ++i) {
        const float unit = static_cast<float>(i) / steps;
        EXPECT_NEAR(srgb_from_linear(linear_from_srgb(unit)), unit, 2e-6F);
        EXPECT_GT(linear_from_srgb(unit), last_linear);
        EXPECT_GT(srgb_from_linear(unit), last_encoded);
        last_linear = linear_from_srgb(unit);
        last_encoded = srgb_from_linear(unit);
    }
}

TEST(Color, BytesAreThoseOfTheFormulaToTheLastFloat) {
    const auto by_formula = [](float linear) {
        return static_cast<std::uint8_t>(std::lround(srgb_from_linear(linear) * 255.0F));
    };
    // Bits of floats from 0 to beyond 1, a prime apart.
    for (std::uint32_t bits = 0; bits < std::bit_cast<std::uint32_t>(1.1F); bits += 4001) {
        const auto linear = std::bit_cast<float>(bits);
        ASSERT_EQ(rgba8_from_linear(glm::vec3(linear)).r, by_formula(linear)) << linear;
    }
    // And next to where a byte begins.
    for (int byte = 0; byte < 255; ++byte) {
        const float near = linear_from_srgb((static_cast<float>(byte) + 0.5F) / 255.0F);
        for (int step = -20; step <= 20; ++step) {
            const auto linear = std::bit_cast<float>(std::bit_cast<std::uint32_t>(near) +
                                                     static_cast<std::uint32_t>(step));
            ASSERT_EQ(rgba8_from_linear(glm::vec3(linear)).r, by_formula(linear)) << linear;
        }
    }
}

} // namespace
} // namespace reljef
