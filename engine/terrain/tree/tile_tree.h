#pragma once

#include <compare>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/geo/georeference.h"
#include "engine/terrain/mesh/tile_layout.h"

namespace reljef::terrain {

/// Largest number of cells along a side of a tree's tile. Fewer than those of tiles in memory:
/// small tiles follow the view more closely, so that more of it fits a small memory.
inline constexpr int tree_tile_cells = 64;

/// A tile of a quadtree over the samples of a raster. At level l every 2^l-th sample is a vertex.
struct TreeTile {
    int level = 0;
    int col = 0; ///< in tiles of the level
    int row = 0;

    friend auto operator<=>(const TreeTile&, const TreeTile&) = default;
};

/// Largest side of a tree, samples.
inline constexpr int max_tree_samples = 1 << 30;

/// A quadtree of tiles with at most `tree_tile_cells` cells a side over a raster of any size.
/// Neighbours share their border vertices. The tree stores no tiles.
class TileTree {
public:
    /// `wrap`: of a closed raster, whose samples `cols` and `rows` count.
    /// Precondition: 2 to max_tree_samples samples a side.
    TileTree(int cols, int rows, const geo::GlobalWrap& wrap = {});

    [[nodiscard]] int cols() const { return last_.x + 1; }
    [[nodiscard]] int rows() const { return last_.y + 1; }
    [[nodiscard]] const geo::GlobalWrap& wrap() const { return source_rows_.wrap(); }
    /// Whether the last column and the first are the same places.
    [[nodiscard]] bool wraps_longitude() const { return wrap().around; }
    [[nodiscard]] TreeTile root() const { return {levels_ - 1, 0, 0}; }
    /// Up to four tiles of the level below; none at level 0.
    [[nodiscard]] std::vector<TreeTile> children(TreeTile tile) const;

    /// Samples from vertex to vertex.
    [[nodiscard]] static int step(TreeTile tile) { return 1 << tile.level; }
    /// Sample (col, row) of the first vertex.
    [[nodiscard]] static glm::ivec2 first(TreeTile tile) {
        return glm::ivec2(tile.col, tile.row) * tree_tile_cells * step(tile);
    }
    /// 1 … tree_tile_cells; the raster's end may cut the last cells. Precondition: in the tree.
    [[nodiscard]] glm::ivec2 cells(TreeTile tile) const;
    /// Sample of a vertex, clamped to the raster.
    [[nodiscard]] glm::ivec2 sample(TreeTile tile, glm::ivec2 vertex) const;
    /// Where a sample lies: its column, and its row among those of the source.
    [[nodiscard]] glm::dvec2 place(glm::ivec2 sample) const {
        return {sample.x, source_rows_.source_row(sample.y)};
    }

private:
    glm::ivec2 last_;
    int levels_ = 1;
    geo::WrappedRows source_rows_;
};

} // namespace reljef::terrain
