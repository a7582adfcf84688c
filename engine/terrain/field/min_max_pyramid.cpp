#include "engine/terrain/field/min_max_pyramid.h"

#include <algorithm>

namespace reljef::terrain {
namespace {

Grid<MinMax> cell_bounds(GridView<const float> heights) {
    Grid<MinMax> bounds(heights.cols() - 1, heights.rows() - 1);
    for (int row = 0; row < bounds.rows(); ++row) {
        for (int col = 0; col < bounds.cols(); ++col) {
            const auto [low, high] =
                std::minmax({heights(col, row), heights(col + 1, row), heights(col, row + 1),
                             heights(col + 1, row + 1)});
            bounds(col, row) = {low, high};
        }
    }
    return bounds;
}

MinMax merged(MinMax a, MinMax b) {
    return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

Grid<MinMax> halved(const Grid<MinMax>& fine) {
    Grid<MinMax> coarse((fine.cols() + 1) / 2, (fine.rows() + 1) / 2);
    for (int row = 0; row < coarse.rows(); ++row) {
        for (int col = 0; col < coarse.cols(); ++col) {
            const int c = 2 * col;
            const int r = 2 * row;
            coarse(col, row) = merged(merged(fine.clamped(c, r), fine.clamped(c + 1, r)),
                                      merged(fine.clamped(c, r + 1), fine.clamped(c + 1, r + 1)));
        }
    }
    return coarse;
}

} // namespace

MinMaxPyramid::MinMaxPyramid(GridView<const float> heights) {
    check(heights.cols() >= 2 && heights.rows() >= 2, "a pyramid needs at least 2x2 samples");
    levels_.push_back(cell_bounds(heights));
    while (levels_.back().size() > 1) {
        levels_.push_back(halved(levels_.back()));
    }
}

MinMax MinMaxPyramid::bounds(glm::ivec2 first, glm::ivec2 last) const {
    int index = 0;
    while (last.x - first.x > 1 || last.y - first.y > 1) {
        first /= 2;
        last /= 2;
        ++index;
    }
    const Grid<MinMax>& blocks = level(index);
    return merged(merged(blocks(first.x, first.y), blocks(last.x, first.y)),
                  merged(blocks(first.x, last.y), blocks(last.x, last.y)));
}

} // namespace reljef::terrain
