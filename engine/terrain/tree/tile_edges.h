#pragma once

#include <set>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/terrain/tree/tile_tree.h"

namespace reljef::terrain {

/// A vertex of a tile of a tree, counted from the tile's first.
struct TreeVertex {
    TreeTile tile;
    glm::ivec2 vertex{0};

    friend bool operator==(const TreeVertex&, const TreeVertex&) = default;
};

/// Where a border vertex of a tile is drawn, when that is not its own place.
struct EdgeMove {
    glm::ivec2 vertex{0};
    TreeVertex to;

    friend bool operator==(const EdgeMove&, const EdgeMove&) = default;
};

/// Where a tile's border vertices go, so that the tiles drawn beside it meet it vertex on vertex:
/// each onto the nearest vertex of the coarsest drawn tile that touches it, of equally coarse ones
/// the first. Where two tiles meet both have the same vertices in the same order, whatever their
/// levels. Preconditions: no two of `drawn` overlap; all are of the tree.
std::vector<EdgeMove> edge_moves(const TileTree& tree, const std::set<TreeTile>& drawn,
                                 TreeTile tile);

} // namespace reljef::terrain
