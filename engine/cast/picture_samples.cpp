#include "engine/cast/picture_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "engine/core/check.h"

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

// Levels of 255 below which a neighbour's colour changes a mean too little to be seen.
constexpr int same_color = 2;

bool differ(Rgba8 a, Rgba8 b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)}) > same_color;
}

// Whether three pixels in a row show one smooth surface.
bool bends(const FirstSamples& first, float before, float here, float after) {
    const float bend = std::abs(before - 2.0F * here + after);
    const float nearest = std::max({before, here, after});
    return bend > first.disagreement * (first.is_perspective ? nearest : 1.0F);
}

bool needs_samples(const FirstSamples& first, glm::ivec2 pixel) {
    const Image& picture = first.picture;
    const Rgba8 color = picture(pixel.x, pixel.y);
    const float here = first.nearness(pixel.x, pixel.y);
    const auto along = [&](glm::ivec2 step) {
        const glm::ivec2 before = pixel - step;
        const glm::ivec2 after = pixel + step;
        if (before.x < 0 || before.y < 0 || after.x >= picture.cols() ||
            after.y >= picture.rows()) {
            return false;
        }
        const bool changes =
            differ(color, picture(before.x, before.y)) || differ(color, picture(after.x, after.y));
        return changes && bends(first, first.nearness(before.x, before.y), here,
                                first.nearness(after.x, after.y));
    };
    return along({1, 0}) || along({0, 1});
}

} // namespace

Result<void> check_samples(int samples) {
    constexpr std::array possible{automatic_samples, 1, 2, 4, 8, 16};
    if (std::find(possible.begin(), possible.end(), samples) != possible.end()) {
        return {};
    }
    return Error{
        fmt::format("picture with {} samples a pixel: expected 1, 2, 4, 8 or 16", samples)};
}

std::span<const glm::ivec2> sixteenths_of(int samples) {
    switch (samples) {
    case 1:
        return one_place;
    case 2:
        return two_places;
    case automatic_samples:
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

void choose_sampled(const FirstSamples& first, const PixelBlock& block, SampledPixels& sampled) {
    sampled.count = 0;
    for (int row = 0; row < block.size.y; ++row) {
        for (int col = 0; col < block.size.x; ++col) {
            if (first.samples_all || needs_samples(first, block.first + glm::ivec2(col, row))) {
                sampled.pixels[static_cast<std::size_t>(sampled.count)] =
                    static_cast<std::uint16_t>(row * block_side + col);
                ++sampled.count;
            }
        }
    }
}

} // namespace reljef::cast
