#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/terrain/tree/level_residuals.h"
#include "engine/terrain/tree/tile_error.h"

// Private to tile_error.cpp and tile_check.cpp.

namespace reljef::terrain {

/// The heights of rows, joined in each column by itself: loops over them become vector code.
class ColumnRanges {
public:
    explicit ColumnRanges(std::size_t cols)
        : low_(cols, infinite), high_(cols, -infinite), voids_(cols, 0.0F) {}

    /// A row: a height for each column, metres; NaN: a void.
    void add(std::span<const float> heights) {
        const float* const more = heights.data();
        float* __restrict const low = low_.data();
        float* __restrict const high = high_.data();
        float* __restrict const voids = voids_.data();
        for (std::size_t i = 0; i < heights.size(); ++i) {
            low[i] = lower(low[i], more[i]);
            high[i] = higher(high[i], more[i]);
            voids[i] = more[i] == more[i] ? voids[i] : 1.0F; // NaN
        }
    }
    /// Joins the range of a tile with those of the columns from `first` to the one before `end`.
    void join_with(TileProof& tile, std::size_t first, std::size_t end) const {
        for (std::size_t i = first; i < end; ++i) {
            tile.low = lower(tile.low, low_[i]);
            tile.high = higher(tile.high, high_[i]);
            tile.has_voids = tile.has_voids || voids_[i] > 0.0F;
        }
    }
    /// How far a height is above or below 0 at most, metres.
    [[nodiscard]] float largest() const {
        float largest = 0.0F;
        for (std::size_t i = 0; i < low_.size(); ++i) {
            largest = higher(higher(largest, high_[i]), -low_[i]);
        }
        return largest;
    }
    [[nodiscard]] std::size_t cols() const { return low_.size(); }
    void clear() { *this = ColumnRanges(cols()); }

private:
    std::vector<float> low_;
    std::vector<float> high_;
    std::vector<float> voids_; // 1: there is one
};

} // namespace reljef::terrain
