#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/grid.h"
#include "tests/terrain/chance.h"

namespace reljef::terrain {

inline constexpr float no_height = std::numeric_limits<float>::quiet_NaN();

/// Hills with noise, now and then of whole metres.
inline Grid<float> made_terrain(test::Chance& chance, int cols, int rows) {
    Grid<float> heights(cols, rows);
    const double rough = std::exp(chance.between(-3.0, 5.0));
    const double wave = chance.between(0.005, 0.3);
    const double base = chance.between(-500.0, 4000.0);
    const bool whole = chance.one_in(2);
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
            const double height = base + 300.0 * std::sin(wave * col) * std::cos(0.7 * wave * row) +
                                  chance.between(-rough, rough);
            heights(col, row) = static_cast<float>(whole ? std::round(height) : height);
        }
    }
    return heights;
}

/// Rectangles of all sizes without heights, but for single samples.
inline void add_voids(test::Chance& chance, Grid<float>& heights) {
    for (int n = chance.whole(1, 8); n > 0; --n) {
        const int cols = chance.whole(1, std::min(300, heights.cols()));
        const int rows = chance.whole(1, std::min(300, heights.rows()));
        const int left = chance.whole(0, heights.cols() - cols);
        const int top = chance.whole(0, heights.rows() - rows);
        for (int row = top; row < top + rows; ++row) {
            for (int col = left; col < left + cols; ++col) {
                heights(col, row) = chance.one_in(500) ? heights(col, row) : no_height;
            }
        }
    }
}

} // namespace reljef::terrain
