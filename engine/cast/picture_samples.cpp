#include "engine/cast/picture_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

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

// Levels of 255 below which a neighbour's colour changes a mean too little to be seen.
constexpr int same_color = 2;

bool differ(Rgba8 a, Rgba8 b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)}) > same_color;
}

// A number for each pixel of a row of a block.
using Row = std::array<std::int32_t, block_side>;

// Sets the pixels that are not on one smooth surface with their neighbours: loops over vector
// lanes.
template <bool is_perspective>
void add_bends(const float* before, const float* here, const float* after, int count,
               float disagreement, Row& bends) {
    for (int i = 0; i < count; ++i) {
        const float bend = std::abs(before[i] - 2.0F * here[i] + after[i]);
        const float nearest = std::max(std::max(before[i], here[i]), after[i]);
        const float allowed = is_perspective ? disagreement * nearest : disagreement;
        bends[static_cast<std::size_t>(i)] |= bend > allowed ? 1 : 0;
    }
}

// Of the pixels from `first` on, all of which have neighbours along `step`.
void add_bends(const FirstSamples& samples, glm::ivec2 first, int count, glm::ivec2 step,
               Row& bends) {
    const auto at = [&](glm::ivec2 pixel) { return &samples.nearness(pixel.x, pixel.y); };
    const auto add = samples.is_perspective ? add_bends<true> : add_bends<false>;
    add(at(first - step), at(first), at(first + step), count, samples.disagreement, bends);
}

// One for each pixel of a row of a block that may show several surfaces.
Row bends_of(const FirstSamples& samples, glm::ivec2 first, int count) {
    const glm::ivec2 size(samples.picture.cols(), samples.picture.rows());
    Row bends{};
    if (first.y > 0 && first.y + 1 < size.y) {
        add_bends(samples, first, count, {0, 1}, bends);
    }
    Row inside{};
    const int skipped = first.x == 0 ? 1 : 0;
    const int end = first.x + count == size.x ? count - 1 : count;
    if (skipped < end) {
        add_bends(samples, first + glm::ivec2(skipped, 0), end - skipped, {1, 0}, inside);
    }
    for (int i = skipped; i < end; ++i) {
        bends[static_cast<std::size_t>(i)] |= inside[static_cast<std::size_t>(i - skipped)];
    }
    return bends;
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

void choose_sampled(const FirstSamples& first, const PixelBlock& block, SampledPixels& sampled) {
    sampled.count = 0;
    for (int row = 0; row < block.size.y; ++row) {
        const glm::ivec2 begin = block.first + glm::ivec2(0, row);
        const Row bends = bends_of(first, begin, block.size.x);
        for (int col = 0; col < block.size.x; ++col) {
            const bool may_be = bends[static_cast<std::size_t>(col)] != 0 &&
                                differs_from_neighbours(first.picture, begin + glm::ivec2(col, 0));
            if (first.samples_all || may_be) {
                sampled.pixels[static_cast<std::size_t>(sampled.count)] =
                    static_cast<std::uint16_t>(row * block_side + col);
                ++sampled.count;
            }
        }
    }
}

} // namespace reljef::cast
