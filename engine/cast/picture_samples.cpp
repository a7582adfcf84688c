#include "engine/cast/picture_samples.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include <glm/common.hpp>

#include "engine/core/check.h"
#include "engine/view/sample_count.h"

namespace reljef::cast {
namespace {

// Sample positions of Direct3D 11 and most GPUs, in 1/16 pixel from the middle, right and down.
constexpr std::array one_place{glm::ivec2(0, 0)};
constexpr std::array two_places{glm::ivec2(4, 4), glm::ivec2(-4, -4)};
constexpr std::array four_places{glm::ivec2(-2, -6), glm::ivec2(6, -2), glm::ivec2(-6, 2),
                                 glm::ivec2(2, 6)};
constexpr std::array eight_places{glm::ivec2(1, -3),  glm::ivec2(-1, 3), glm::ivec2(5, 1),
                                  glm::ivec2(-3, -5), glm::ivec2(-5, 5), glm::ivec2(-7, -1),
                                  glm::ivec2(3, 7),   glm::ivec2(7, -7)};
constexpr std::array sixteen_places{
    glm::ivec2(1, 1),   glm::ivec2(-1, -3), glm::ivec2(-3, 2),  glm::ivec2(4, -1),
    glm::ivec2(-5, -2), glm::ivec2(2, 5),   glm::ivec2(5, 3),   glm::ivec2(3, -5),
    glm::ivec2(-2, 6),  glm::ivec2(0, -7),  glm::ivec2(-4, -6), glm::ivec2(-6, 4),
    glm::ivec2(-8, 0),  glm::ivec2(7, -4),  glm::ivec2(6, 7),   glm::ivec2(-7, -8)};

// Levels of 255 up to which a neighbour's colour changes a mean too little to be seen: a third of a
// pixel's samples may be on its surface, and change it by 2.
constexpr int same_color = 6;

bool differ(Rgba8 a, Rgba8 b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)}) > same_color;
}

bool differs_from_neighbours(const Image& picture, glm::ivec2 pixel) {
    const Rgba8 color = picture(pixel.x, pixel.y);
    return differ(color, picture.clamped(pixel.x - 1, pixel.y)) ||
           differ(color, picture.clamped(pixel.x + 1, pixel.y)) ||
           differ(color, picture.clamped(pixel.x, pixel.y - 1)) ||
           differ(color, picture.clamped(pixel.x, pixel.y + 1));
}

} // namespace

std::span<const glm::ivec2> sixteenths_of(int samples) {
    switch (samples) {
    case 1:
        return one_place;
    case 2:
        return two_places;
    case view::automatic_samples:
    case 4:
        return four_places;
    case 8:
        return eight_places;
    case 16:
        return sixteen_places;
    default:
        abort_with("an unknown number of samples");
    }
}

void FirstSamples::resize(glm::ivec2 size) {
    const int blocks = (size.x + block_side - 1) / block_side;
    picture = Image(size.x, size.y);
    nearness =
        Grid<float>(blocks * block_side + 2, size.y + 2, std::numeric_limits<float>::quiet_NaN());
}

void FirstSamples::write_nearness(const BlockPixels& pixels, const PixelBlock& block,
                                  const PixelBlock& of) {
    const glm::ivec2 low = glm::clamp(of.first - block.first, glm::ivec2(0), block.size);
    const glm::ivec2 high = glm::clamp(of.first + of.size - block.first, low, block.size);
    constexpr float beside = std::numeric_limits<float>::quiet_NaN();
    for (int row = 0; row < block.size.y; ++row) {
        const float* const from =
            pixels.nearness.data() + static_cast<std::size_t>(row) * block_side;
        float* const to = nearness_at(block.first + glm::ivec2(0, row));
        const bool is_inside = row >= low.y && row < high.y;
        const int begin = is_inside ? low.x : block.size.x;
        const int end = is_inside ? high.x : block.size.x;
        std::fill(to, to + begin, beside);
        std::copy(from + begin, from + end, to + begin);
        std::fill(to + end, to + block.size.x, beside);
    }
}

void choose_sampled(const FirstSamples& first, const BlockKernel& kernel, const PixelBlock& block,
                    SampledPixels& sampled) {
    sampled.count = 0;
    const std::uint32_t all = block.size.x < block_side ? (1U << block.size.x) - 1U : ~0U;
    for (int row = 0; row < block.size.y; ++row) {
        const glm::ivec2 begin = block.first + glm::ivec2(0, row);
        NearnessRows rows;
        rows.above = first.nearness_at(begin - glm::ivec2(0, 1));
        rows.here = first.nearness_at(begin);
        rows.below = first.nearness_at(begin + glm::ivec2(0, 1));
        rows.is_perspective = first.is_perspective;
        rows.disagreement = first.disagreement;
        std::uint32_t left = first.samples_all ? all : kernel.bends(rows) & all;
        for (; left != 0; left &= left - 1) {
            const int col = std::countr_zero(left);
            if (first.samples_all ||
                differs_from_neighbours(first.picture, begin + glm::ivec2(col, 0))) {
                sampled.pixels[static_cast<std::size_t>(sampled.count)] =
                    static_cast<std::uint16_t>(row * block_side + col);
                ++sampled.count;
            }
        }
    }
}

} // namespace reljef::cast
