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

// Rows and columns of a block along its borders.
constexpr std::array border_lines{0, 1, block_side - 2, block_side - 1};
constexpr int lines_a_block = static_cast<int>(border_lines.size());

std::size_t block_index(int col, int row) {
    return static_cast<std::size_t>(row) * block_side + static_cast<std::size_t>(col);
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
    const glm::ivec2 blocks = (size + block_side - 1) / block_side;
    constexpr float beside = std::numeric_limits<float>::quiet_NaN();
    picture = Image(size.x, size.y);
    bends = Grid<std::uint32_t>(blocks.x, blocks.y * block_side);
    border_rows = Grid<float>(blocks.x * block_side + 2, lines_a_block * blocks.y + 2, beside);
    border_cols = Grid<float>(blocks.y * block_side + 2, lines_a_block * blocks.x + 2, beside);
}

namespace {

void clear_beside(BlockPixels& pixels, const PixelBlock& block, const PixelBlock& of) {
    const glm::ivec2 low = glm::clamp(of.first - block.first, glm::ivec2(0), block.size);
    const glm::ivec2 high = glm::clamp(of.first + of.size - block.first, low, block.size);
    if (low == glm::ivec2(0) && high == glm::ivec2(block_side)) {
        return;
    }
    for (int row = 0; row < block_side; ++row) {
        for (int col = 0; col < block_side; ++col) {
            if (col < low.x || col >= high.x || row < low.y || row >= high.y) {
                pixels.nearness[block_index(col, row)] = std::numeric_limits<float>::quiet_NaN();
            }
        }
    }
}

} // namespace

void FirstSamples::add_nearness(BlockPixels& pixels, const PixelBlock& block, const PixelBlock& of,
                                const BlockKernel& kernel) {
    clear_beside(pixels, block, of);
    constexpr int inner_rows = block_side - 2;
    constexpr std::uint32_t inner_cols = ~0U << 1U & ~0U >> 1U;
    std::array<std::uint32_t, inner_rows> inner{};
    kernel.bends({pixels.nearness.data() + block_side, block_side, is_perspective, disagreement},
                 inner);
    const glm::ivec2 number = block.first / block_side;
    for (int i = 0; i < inner_rows; ++i) {
        bends(number.x, block.first.y + 1 + i) = inner[static_cast<std::size_t>(i)] & inner_cols;
    }
    for (int i = 0; i < lines_a_block; ++i) {
        const int line = border_lines[static_cast<std::size_t>(i)];
        std::copy_n(pixels.nearness.data() + block_index(0, line), block_side,
                    &border_rows(block.first.x + 1, lines_a_block * number.y + 1 + i));
        float* const to = &border_cols(block.first.y + 1, lines_a_block * number.x + 1 + i);
        for (int row = 0; row < block_side; ++row) {
            to[row] = pixels.nearness[block_index(line, row)];
        }
    }
}

namespace {

using BlockBits = std::array<std::uint32_t, block_side>; // pixels by row

// Along the first or the last line of a block.
std::uint32_t border_bends(const FirstSamples& first, const BlockKernel& kernel,
                           const Grid<float>& borders, int begin, int line) {
    std::array<std::uint32_t, 1> bits{};
    kernel.bends(
        {&borders(begin + 1, line + 1), borders.cols(), first.is_perspective, first.disagreement},
        bits);
    return bits.front();
}

BlockBits bends_of(const FirstSamples& first, const BlockKernel& kernel, const PixelBlock& block) {
    const glm::ivec2 number = block.first / block_side;
    const auto along_row = [&](int line) {
        return border_bends(first, kernel, first.border_rows, block.first.x,
                            lines_a_block * number.y + line);
    };
    const auto along_col = [&](int line) {
        return border_bends(first, kernel, first.border_cols, block.first.y,
                            lines_a_block * number.x + line);
    };
    BlockBits bits{};
    for (int row = 1; row < block_side - 1; ++row) {
        bits[static_cast<std::size_t>(row)] = first.bends(number.x, block.first.y + row);
    }
    bits.front() = along_row(0);
    bits.back() = along_row(lines_a_block - 1);
    const std::uint32_t left = along_col(0);
    const std::uint32_t right = along_col(lines_a_block - 1);
    for (unsigned row = 0; row < bits.size(); ++row) {
        bits[row] |= (left >> row & 1U) | (right >> row & 1U) << (block_side - 1U);
    }
    return bits;
}

} // namespace

std::vector<std::uint16_t> sampled_pixels(const FirstSamples& first, const BlockKernel& kernel,
                                          const PixelBlock& block) {
    BlockBits bits{};
    if (first.samples_all) {
        bits.fill(~0U);
    } else {
        bits = bends_of(first, kernel, block);
    }
    std::vector<std::uint16_t> pixels;
    const auto add = [&](int col, int row) {
        if (col < block.size.x && row < block.size.y &&
            (first.samples_all ||
             differs_from_neighbours(first.picture, block.first + glm::ivec2(col, row)))) {
            pixels.push_back(static_cast<std::uint16_t>(block_index(col, row)));
        }
    };
    constexpr std::uint32_t beam_bits = (1U << static_cast<unsigned>(beam_cols)) - 1U;
    for (int beam = 0; beam < beam_count; ++beam) {
        const int first_col = beam % beams_a_row * beam_cols;
        const int first_row = beam / beams_a_row * beam_rows;
        for (int row = first_row; row < first_row + beam_rows; ++row) {
            std::uint32_t left =
                bits[static_cast<std::size_t>(row)] >> static_cast<unsigned>(first_col) & beam_bits;
            for (; left != 0; left &= left - 1) {
                add(first_col + std::countr_zero(left), row);
            }
        }
    }
    return pixels;
}

} // namespace reljef::cast
