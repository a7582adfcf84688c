#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <unordered_map>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/grid.h"
#include "engine/terrain/mesh/bisection_mesh.h"
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

/// Tiles of a tree that are drawn together, and where they meet.
class DrawnTiles {
public:
    /// Preconditions: as edge_moves() for each of `drawn`.
    DrawnTiles(const TileTree& tree, std::set<TreeTile> drawn);

    [[nodiscard]] const std::set<TreeTile>& tiles() const { return tiles_; }
    /// As edge_moves(). Precondition: one of tiles().
    [[nodiscard]] const std::vector<EdgeMove>& moves(TreeTile tile) const {
        return edges_.at(tile).moves;
    }
    /// The tiles that it shares samples with. Precondition: one of tiles().
    [[nodiscard]] const std::vector<TreeTile>& touching(TreeTile tile) const {
        return edges_.at(tile).touching;
    }
    /// The border vertices of other tiles that must be there where this one is, for tiles to meet
    /// vertex on vertex: the one that it is moved onto, and those at its own place.
    [[nodiscard]] std::vector<TreeVertex> partners(const TreeVertex& vertex) const;

private:
    struct TileEdges {
        std::vector<EdgeMove> moves;
        std::unordered_map<int, TreeVertex> moved; // by the vertex' number, row after row
        std::vector<TreeTile> touching;
    };
    [[nodiscard]] int number_of(const TreeVertex& vertex) const;

    TileTree tree_;
    std::set<TreeTile> tiles_;
    std::map<TreeTile, TileEdges> edges_;
};

/// Where the bisection of a heightfield that is one tile splits its border for a view: vertices
/// (col, row). Precondition: at most tile_cells cells a side.
std::vector<glm::ivec2> border_splits(const Bisection& bisection, const ErrorView& view);

/// By tile of a cover.
using BorderSplits = std::map<TreeTile, std::vector<glm::ivec2>>;
/// Of the vertices of each tile of a cover, 1 where its bisection must split.
using SharedSplits = std::map<TreeTile, Grid<std::uint8_t>>;

/// The fewest splits with those in `wanted` and all that they need, where each border vertex is
/// there for both tiles that meet at it: so the tiles meet vertex on vertex, whatever their levels
/// and the views that they were cut for. Precondition: a row in `wanted` for each tile.
SharedSplits shared_splits(const TileTree& tree, const DrawnTiles& cover,
                           const BorderSplits& required);

} // namespace reljef::terrain
