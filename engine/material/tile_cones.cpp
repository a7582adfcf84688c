#include "engine/material/tile_cones.h"

#include <algorithm>

namespace reljef::material {
namespace {

// From the shorter side: the field of a strip stays a strip.
int field_margin(int cols, int rows, WrapMode border) {
    return border == WrapMode::wrap ? std::max(std::min(cols, rows) / 4, 1) : 0;
}

} // namespace

Grid<float> cone_field(GridView<const float> heights, WrapMode border) {
    const int margin = field_margin(heights.cols(), heights.rows(), border);
    const bool wraps = border == WrapMode::wrap;
    // A cell has four samples.
    const int cols = wraps ? heights.cols() + 2 * margin + 1 : std::max(heights.cols(), 2);
    const int rows = wraps ? heights.rows() + 2 * margin + 1 : std::max(heights.rows(), 2);
    Grid<float> field(cols, rows);
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
            field(col, row) = heights(index_beyond(col - margin, heights.cols(), border),
                                      index_beyond(row - margin, heights.rows(), border));
        }
    }
    return field;
}

Grid<float> tile_cones(const Grid<float>& of_field, int cols, int rows, WrapMode border) {
    const int margin = field_margin(cols, rows, border);
    const bool wraps = border == WrapMode::wrap;
    const float widest = wraps ? static_cast<float>(margin) : max_cone_ratio;
    Grid<float> cones(wraps ? cols : std::max(cols - 1, 1), wraps ? rows : std::max(rows - 1, 1));
    for (int row = 0; row < cones.rows(); ++row) {
        for (int col = 0; col < cones.cols(); ++col) {
            cones(col, row) = std::min(of_field(col + margin, row + margin), widest);
        }
    }
    return cones;
}

ConeMaps tile_cones(const ConeMaps& of_field, int cols, int rows, WrapMode border) {
    Grid<float> plain = tile_cones(of_field.plain, cols, rows, border);
    if (border != WrapMode::wrap) {
        return {plain, plain};
    }
    return {std::move(plain), tile_cones(of_field.relaxed, cols, rows, border)};
}

} // namespace reljef::material
