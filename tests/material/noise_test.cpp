#include "engine/material/noise.h"

#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace reljef::material {
namespace {

constexpr int cases = 20000;

class Points {
public:
    explicit Points(float reach) : coordinate_(-reach, reach) {}
    glm::vec2 operator()() { return {coordinate_(engine_), coordinate_(engine_)}; }

private:
    std::mt19937 engine_{7};
    std::uniform_real_distribution<float> coordinate_;
};

TEST(Noise, HashTellsItsArgumentsApart) {
    EXPECT_NE(hash(1, 2, 3), hash(1, 3, 2));
    EXPECT_NE(hash(1, 2, 3), hash(2, 1, 3));
    EXPECT_NE(hash(0, 0, 0), hash(0, 0, -1));
    EXPECT_NE(hash(0, 0, 0), hash(0, -1, 0));
}

TEST(Noise, HashFlipsEveryBitHalfOfTheTime) {
    int flips[32] = {};
    for (int i = 0; i < cases; ++i) {
        const std::uint32_t changed = hash(5, i, 11) ^ hash(5, i + 1, 11);
        for (unsigned bit = 0; bit < 32; ++bit) {
            flips[bit] += static_cast<int>(changed >> bit & 1U);
        }
    }
    for (const int count : flips) {
        EXPECT_NEAR(static_cast<double>(count) / cases, 0.5, 0.03);
    }
}

TEST(Noise, UnitHashIsUniformInUnitInterval) {
    int counts[10] = {};
    for (int i = 0; i < cases; ++i) {
        const float value = unit_hash(3, i % 141, i / 141);
        ASSERT_GE(value, 0.0F);
        ASSERT_LT(value, 1.0F);
        ++counts[static_cast<int>(value * 10.0F)];
    }
    for (const int count : counts) {
        EXPECT_NEAR(static_cast<double>(count) / cases, 0.1, 0.01);
    }
}

TEST(Noise, GradientNoiseVanishesOnTheLattice) {
    for (int row = -20; row < 20; ++row) {
        for (int col = -20; col < 20; ++col) {
            const glm::vec2 corner{static_cast<float>(col), static_cast<float>(row)};
            ASSERT_EQ(gradient_noise(9, corner), 0.0F);
        }
    }
}

TEST(Noise, GradientNoiseHasZeroMeanAndFillsItsRange) {
    Points points(500.0F);
    double sum = 0.0;
    float low = 0.0F;
    float high = 0.0F;
    for (int i = 0; i < cases; ++i) {
        const float value = gradient_noise(1, points());
        sum += static_cast<double>(value);
        low = std::min(low, value);
        high = std::max(high, value);
    }
    EXPECT_NEAR(sum / cases, 0.0, 0.01);
    EXPECT_GT(low, -1.2F);
    EXPECT_LT(low, -0.7F);
    EXPECT_LT(high, 1.2F);
    EXPECT_GT(high, 0.7F);
}

TEST(Noise, GradientNoiseIsContinuousOverCellBorders) {
    Points points(200.0F);
    for (int i = 0; i < cases; ++i) {
        glm::vec2 point = points();
        if (i % 2 == 0) {
            point.x = std::round(point.x);
        }
        const glm::vec2 step = 1.0e-3F * glm::normalize(points() + glm::vec2{0.01F});
        const float change = gradient_noise(4, point + step) - gradient_noise(4, point - step);
        ASSERT_LT(std::abs(change), 2.0e-3F * 6.0F);
    }
}

TEST(Noise, PeriodRepeatsNegativeCellsToo) {
    Points points(40.0F);
    for (const std::int32_t period : {1, 3, 8}) {
        for (int i = 0; i < 2000; ++i) {
            // Sixteenths survive the addition of a period without rounding.
            const glm::vec2 point = glm::round(points() * 16.0F) / 16.0F;
            const auto shift = static_cast<float>(period);
            const float value = gradient_noise(2, point, period);
            ASSERT_EQ(value, gradient_noise(2, {point.x + shift, point.y}, period));
            ASSERT_EQ(value, gradient_noise(2, {point.x, point.y - 2.0F * shift}, period));
        }
    }
}

TEST(Noise, WithoutPeriodNothingRepeats) {
    Points points(40.0F);
    int same = 0;
    for (int i = 0; i < 1000; ++i) {
        const glm::vec2 point = points();
        same += gradient_noise(2, point) == gradient_noise(2, {point.x + 8.0F, point.y}) ? 1 : 0;
    }
    EXPECT_LT(same, 10);
}

TEST(Noise, FractalNoiseOfOneOctaveIsGradientNoise) {
    Points points(40.0F);
    for (int i = 0; i < 1000; ++i) {
        const glm::vec2 point = points();
        ASSERT_EQ(fractal_noise(8, point, {.octaves = 1}), gradient_noise(8, point));
    }
}

TEST(Noise, FractalNoiseStaysInRangeAndKeepsThePeriodOfItsFirstOctave) {
    Points points(40.0F);
    double sum = 0.0;
    for (int i = 0; i < cases; ++i) {
        const glm::vec2 point = glm::round(points() * 16.0F) / 16.0F;
        const float value = fractal_noise(6, point, {.octaves = 5, .gain = 0.6F, .period = 4});
        ASSERT_LT(std::abs(value), 1.2F);
        ASSERT_EQ(value, fractal_noise(6, {point.x + 4.0F, point.y - 4.0F},
                                       {.octaves = 5, .gain = 0.6F, .period = 4}));
        sum += static_cast<double>(value);
    }
    EXPECT_NEAR(sum / cases, 0.0, 0.06); // 16 cells only
}

TEST(Noise, SeedsGiveOtherNoise) {
    Points points(40.0F);
    double product = 0.0;
    double square = 0.0;
    for (int i = 0; i < cases; ++i) {
        const glm::vec2 point = points();
        const auto one = static_cast<double>(gradient_noise(1, point));
        product += one * static_cast<double>(gradient_noise(2, point));
        square += one * one;
    }
    EXPECT_LT(std::abs(product / square), 0.05);
}

} // namespace
} // namespace reljef::material
