#include "engine/terrain/field/min_max_pyramid.h"

#include <algorithm>
#include <span>

namespace reljef::terrain {
namespace {

MinMax merged(MinMax a, MinMax b) {
    return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

MinMax merged(MinMax a, MinMax b, MinMax c, MinMax d) {
    return merged(merged(a, b), merged(c, d));
}

// Of blocks of 2×2 cells: 3×3 samples, fewer at the end.
Grid<MinMax> block_bounds(GridView<const float> heights) {
    Grid<MinMax> bounds(heights.cols() / 2, heights.rows() / 2);
    const auto of_row = [&](int col, int row) {
        const std::span<const float> samples = heights.row(std::min(row, heights.rows() - 1));
        const int last = std::min(col + 2, heights.cols() - 1);
        const auto [low, high] =
            std::minmax_element(samples.begin() + col, samples.begin() + last + 1);
        return MinMax{*low, *high};
    };
    for (int row = 0; row < bounds.rows(); ++row) {
        for (int col = 0; col < bounds.cols(); ++col) {
            bounds(col, row) =
                merged(of_row(2 * col, 2 * row),
                       merged(of_row(2 * col, 2 * row + 1), of_row(2 * col, 2 * row + 2)));
        }
    }
    return bounds;
}

Grid<MinMax> halved(const Grid<MinMax>& fine) {
    Grid<MinMax> coarse((fine.cols() + 1) / 2, (fine.rows() + 1) / 2);
    for (int row = 0; row < coarse.rows(); ++row) {
        for (int col = 0; col < coarse.cols(); ++col) {
            const int c = 2 * col;
            const int r = 2 * row;
            coarse(col, row) = merged(fine.clamped(c, r), fine.clamped(c + 1, r),
                                      fine.clamped(c, r + 1), fine.clamped(c + 1, r + 1));
        }
    }
    return coarse;
}

} // namespace

MinMaxPyramid::MinMaxPyramid(GridView<const float> heights) {
    check(heights.cols() >= 2 && heights.rows() >= 2, "a pyramid needs at least 2x2 samples");
    levels_.push_back(block_bounds(heights));
    while (levels_.back().size() > 1) {
        levels_.push_back(halved(levels_.back()));
    }
}

MinMax MinMaxPyramid::bounds(glm::ivec2 first, glm::ivec2 last) const {
    int index = 0;
    do {
        first /= 2;
        last /= 2;
        ++index;
    } while (last.x - first.x > 1 || last.y - first.y > 1);
    const Grid<MinMax>& blocks = level(index);
    return merged(blocks(first.x, first.y), blocks(last.x, first.y), blocks(first.x, last.y),
                  blocks(last.x, last.y));
}

} // namespace reljef::terrain
