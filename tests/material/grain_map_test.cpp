#include "engine/material/grain_map.h"

#include <array>
#include <cmath>
#include <cstddef>

#include <glm/common.hpp>
#include <gtest/gtest.h>

namespace reljef::material {
namespace {

constexpr int side = GrainMap::side;
constexpr std::array layers{GrainMap::soil, GrainMap::scree, GrainMap::grass, GrainMap::rock,
                            GrainMap::snow};

const GrainMap& grain_map() {
    static const GrainMap map;
    return map;
}

glm::dvec3 texel(GrainMap::Layer layer, int level, int col, int row) {
    const int width = side >> level;
    return glm::dvec3(
        grain_of(grain_map().level(layer, level)[static_cast<std::size_t>(row * width + col)]));
}

TEST(GrainMap, ChangesNothingInTheMeanAndAlwaysAsMuch) {
    for (const GrainMap::Layer layer : layers) {
        glm::dvec3 sum(0.0);
        glm::dvec3 squares(0.0);
        for (int i = 0; i < side * side; ++i) {
            const glm::dvec3 grain = texel(layer, 0, i % side, i / side);
            sum += grain;
            squares += grain * grain;
        }
        const glm::vec2 deviation = GrainMap::deviation(layer);
        for (int channel = 0; channel < 3; ++channel) {
            const double mean = sum[channel] / (side * side);
            // Of the few texels beyond the range, too.
            EXPECT_NEAR(mean, 0.0, 2e-3);
            EXPECT_NEAR(std::sqrt(squares[channel] / (side * side) - mean * mean),
                        static_cast<double>(channel < 2 ? deviation.x : deviation.y), 4e-3)
                << layer;
        }
    }
}

// The slopes are those of heights that repeat: along each row and column they add up to nothing.
TEST(GrainMap, SlopesLeadBackToWhereTheyBegan) {
    constexpr double rounded = 0.5 * 2.0 / 1023.0; // of each texel, at most
    for (const GrainMap::Layer layer : {GrainMap::soil, GrainMap::grass, GrainMap::snow}) {
        for (int index = 0; index < side; ++index) {
            glm::dvec2 sums(0.0);
            for (int i = 0; i < side; ++i) {
                sums += glm::dvec2(texel(layer, 0, i, index).x, texel(layer, 0, index, i).y);
            }
            EXPECT_LE(std::abs(sums.x), side * rounded) << index;
            EXPECT_LE(std::abs(sums.y), side * rounded) << index;
        }
    }
}

TEST(GrainMap, LevelsAreMeansOfTheFinerOnes) {
    constexpr double rounded = 2.0 / 1023.0; // of both levels
    for (const GrainMap::Layer layer : layers) {
        for (int level = 1; level < GrainMap::level_count; ++level) {
            for (int row = 0; row < side >> level; ++row) {
                for (int col = 0; col < side >> level; ++col) {
                    glm::dvec3 mean(0.0);
                    glm::dvec3 largest(0.0);
                    for (int k = 0; k < 4; ++k) {
                        const glm::dvec3 fine =
                            texel(layer, level - 1, 2 * col + k % 2, 2 * row + k / 2);
                        mean += 0.25 * fine;
                        largest = glm::max(largest, glm::abs(fine));
                    }
                    const glm::dvec3 off = glm::abs(texel(layer, level, col, row) - mean);
                    for (int channel = 0; channel < 3; ++channel) {
                        const bool is_cut = largest[channel] > 1.0 - rounded; // after the mean
                        ASSERT_LE(off[channel], is_cut ? 0.1 : rounded) << layer;
                    }
                }
            }
        }
    }
}

TEST(GrainMap, IsTheSameEachTime) {
    const GrainMap again;
    EXPECT_TRUE(std::equal(again.texels().begin(), again.texels().end(),
                           grain_map().texels().begin(), grain_map().texels().end()));
}

} // namespace
} // namespace reljef::material
