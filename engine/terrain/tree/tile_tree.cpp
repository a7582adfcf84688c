#include "engine/terrain/tree/tile_tree.h"

#include <algorithm>

#include <glm/common.hpp>

#include "engine/core/check.h"

namespace reljef::terrain {

TileTree::TileTree(int cols, int rows, const geo::GlobalWrap& wrap)
    : last_(cols - 1, rows - 1), source_rows_(wrap, rows - wrap.rows()) {
    check(std::min(cols, rows) >= 2 && std::max(cols, rows) <= max_tree_samples,
          "a tile tree needs 2 to 2^30 samples a side");
    while (tree_tile_cells * step({levels_ - 1, 0, 0}) < std::max(last_.x, last_.y)) {
        ++levels_;
    }
}

std::vector<TreeTile> TileTree::children(TreeTile tile) const {
    std::vector<TreeTile> found;
    if (tile.level == 0) {
        return found;
    }
    for (const int row : {2 * tile.row, 2 * tile.row + 1}) {
        for (const int col : {2 * tile.col, 2 * tile.col + 1}) {
            const TreeTile child{tile.level - 1, col, row};
            const glm::ivec2 corner = first(child);
            if (corner.x < last_.x && corner.y < last_.y) {
                found.push_back(child);
            }
        }
    }
    return found;
}

glm::ivec2 TileTree::cells(TreeTile tile) const {
    const glm::ivec2 left = last_ - first(tile);
    return glm::clamp((left + step(tile) - 1) / step(tile), glm::ivec2(0),
                      glm::ivec2(tree_tile_cells));
}

glm::ivec2 TileTree::sample(TreeTile tile, glm::ivec2 vertex) const {
    return glm::clamp(first(tile) + vertex * step(tile), glm::ivec2(0), last_);
}

} // namespace reljef::terrain
