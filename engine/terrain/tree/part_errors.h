#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <tuple>

#include "engine/terrain/tree/level_residuals.h"
#include "engine/terrain/tree/tile_error.h"

// The errors of a tile's parts and blocks. Private to tile_error.cpp and tile_check.cpp.

namespace reljef::terrain {

/// Metres, of the parts of a tile.
using PartErrors = std::array<float, std::tuple_size_v<PartShares>>;
using BlockErrors = std::array<float, std::tuple_size_v<BlockShares>>;

inline std::size_t block_of_part(std::size_t part) {
    constexpr std::size_t parts_per_block = error_parts / error_blocks;
    return part / error_parts / parts_per_block * error_blocks +
           part % error_parts / parts_per_block;
}

inline BlockErrors block_errors(const PartErrors& parts) {
    BlockErrors blocks{};
    for (std::size_t i = 0; i < parts.size(); ++i) {
        float& largest = blocks.at(block_of_part(i));
        largest = higher(largest, parts.at(i));
    }
    return blocks;
}

/// Errors as shares of the largest one. `rounding`: metres, of each error.
template <std::size_t count>
std::array<std::uint8_t, count> shares_of(const std::array<float, count>& errors, float rounding,
                                          float largest) {
    std::array<std::uint8_t, count> shares{};
    for (std::size_t i = 0; i < count && largest > 0.0F; ++i) {
        const float share = std::ceil(255.0F * ((errors.at(i) + rounding) / largest));
        shares.at(i) = static_cast<std::uint8_t>(std::min(share + 1.0F, 255.0F)); // the division
    }
    return shares;
}

// Of errors of a level, in units of the largest height, 2^-24 each for: shares along both axes (4
// and 4: two products, their sum, and the share itself), the difference of heights (2), and its sum
// with a residual (4: widen() bounds it by twice the largest height).
inline constexpr float rounding_of_errors = 14.0F / 16777216.0F;

// Of heights of the next level, 2^-24 of the largest for each of nine sums.
inline constexpr float rounding_per_level = 9.0F / 16777216.0F;

} // namespace reljef::terrain
