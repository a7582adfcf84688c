#pragma once

#include <compare>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/terrain/mesh/tile_layout.h"

namespace reljef::terrain {

/// A tile of a quadtree over the samples of a raster. At level 0 every sample is a vertex, at each
/// level above every second of the one below.
struct TreeTile {
    int level = 0;
    int col = 0; ///< in tiles of the level
    int row = 0;

    friend auto operator<=>(const TreeTile&, const TreeTile&) = default;
};

/// The most samples a side that a tree reaches.
inline constexpr int max_tree_samples = 1 << 30;

/// Tiles of at most `tile_cells` cells a side over a raster of any size, each of which is covered
/// by up to four of the level below. Neighbours share their border vertices. Nothing is kept: a
/// tile is where its numbers say.
class TileTree {
public:
    /// `wraps_longitude`: the last column lies where the first does, and tiles of both meet.
    /// Precondition: 2 to max_tree_samples samples a side.
    TileTree(int cols, int rows, bool wraps_longitude = false);

    [[nodiscard]] int cols() const { return last_.x + 1; }
    [[nodiscard]] int rows() const { return last_.y + 1; }
    /// The column at the other end, where that is the same place; else the column itself.
    [[nodiscard]] int other_end(int col) const;
    /// How many columns of tiles a level has.
    [[nodiscard]] int tile_cols(int level) const;
    [[nodiscard]] bool wraps_longitude() const { return is_around_; }
    /// The tile that covers all.
    [[nodiscard]] TreeTile root() const { return {levels_ - 1, 0, 0}; }
    /// The tiles below that cover it; none at level 0.
    [[nodiscard]] std::vector<TreeTile> children(TreeTile tile) const;

    /// Samples from vertex to vertex.
    [[nodiscard]] static int step(TreeTile tile) { return 1 << tile.level; }
    /// Sample (col, row) of the first vertex.
    [[nodiscard]] static glm::ivec2 first(TreeTile tile);
    /// 1 … tile_cells where the tile is in the tree; the last ones may be cut by the raster's end.
    [[nodiscard]] glm::ivec2 cells(TreeTile tile) const;
    /// Sample where a vertex lies: on the raster's border where its step leads beyond.
    [[nodiscard]] glm::ivec2 sample(TreeTile tile, glm::ivec2 vertex) const;

private:
    glm::ivec2 last_;
    int levels_ = 1;
    bool is_around_ = false;
};

} // namespace reljef::terrain
