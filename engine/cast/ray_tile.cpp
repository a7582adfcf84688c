#include "engine/cast/ray_tile.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace reljef::cast {
namespace {

// Blocks of 64 cells: larger ones are skipped by the beams.
constexpr int max_top_level = 6;

int rounded_up(int count, int multiple) {
    return (count + multiple - 1) / multiple * multiple;
}

// The level whose blocks are as long as `cells`.
int level_of(int cells) {
    return static_cast<int>(std::bit_width(static_cast<unsigned>(cells)));
}

} // namespace

RayTile::RayTile(GridView<const float> heights) : heights_(heights) {
    if (heights.cols() < 2 || heights.rows() < 2) {
        return;
    }
    cells_ = {heights.cols() - 1, heights.rows() - 1};
    top_level_ = std::min(level_of(std::max(cells_.x, cells_.y) - 1), max_top_level);
    const int block = 1 << top_level_;
    rows_ = rounded_up(cells_.y, block);
    stride_ = rounded_up(cells_.x, block);
    maxima_.assign(index_of(top_level_, {0, rows_ >> top_level_}),
                   std::numeric_limits<float>::lowest());
    fill_cells();
    for (int level = 1; level <= top_level_; ++level) {
        fill_level(level);
    }
}

void RayTile::fill_cells() {
    total_ = {heights_(0, 0), heights_(0, 0)};
    for (int row = 0; row <= cells_.y; ++row) {
        const auto [low, high] = std::ranges::minmax(heights_.row(row));
        total_ = {std::min(total_.low, low), std::max(total_.high, high)};
    }
    for (int row = 0; row < cells_.y; ++row) {
        const float* const north = heights_.row(row).data();
        const float* const south = heights_.row(row + 1).data();
        float* const maxima = &maxima_[index_of(0, {0, row})];
        for (int col = 0; col < cells_.x; ++col) {
            maxima[col] = std::max(std::max(north[col], north[col + 1]),
                                   std::max(south[col], south[col + 1]));
        }
    }
}

void RayTile::fill_level(int level) {
    const glm::ivec2 blocks(stride_ >> level, rows_ >> level);
    for (int row = 0; row < blocks.y; ++row) {
        for (int col = 0; col < blocks.x; ++col) {
            const glm::ivec2 fine(2 * col, 2 * row);
            maxima_[index_of(level, {col, row})] =
                std::max({max_of(level - 1, fine), max_of(level - 1, fine + glm::ivec2(1, 0)),
                          max_of(level - 1, fine + glm::ivec2(0, 1)), max_of(level - 1, fine + 1)});
        }
    }
}

float RayTile::max_within(glm::ivec2 first, glm::ivec2 last) const {
    const int extent = std::max(last.x - first.x, last.y - first.y);
    const int level = std::min(level_of(extent), top_level_);
    float highest = std::numeric_limits<float>::lowest();
    for (int row = first.y >> level; row <= last.y >> level; ++row) {
        for (int col = first.x >> level; col <= last.x >> level; ++col) {
            highest = std::max(highest, max_of(level, {col, row}));
        }
    }
    return highest;
}

} // namespace reljef::cast
