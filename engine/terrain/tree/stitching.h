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

/// A vertex of a tile, counted from the tile's first.
struct TreeVertex {
    TreeTile tile;
    glm::ivec2 vertex{0};

    friend bool operator==(const TreeVertex&, const TreeVertex&) = default;
};

/// Draws a border vertex at the position of another tile's vertex.
struct EdgeMove {
    glm::ivec2 vertex{0};
    TreeVertex to;

    friend bool operator==(const EdgeMove&, const EdgeMove&) = default;
};

/// The moves of a tile's border vertices that close the cracks to its drawn neighbours, whatever
/// their levels. A vertex moves onto the nearest vertex of the coarsest drawn tile that touches it;
/// ties go to the first tile. Preconditions: `drawn` are tiles of the tree that do not overlap.
std::vector<EdgeMove> edge_moves(const TileTree& tree, const std::set<TreeTile>& drawn,
                                 TreeTile tile);

/// Tiles of a tree that are drawn together. Precondition of all functions: a tile of tiles().
class DrawnTiles {
public:
    /// Preconditions: as edge_moves().
    DrawnTiles(const TileTree& tree, std::set<TreeTile> drawn);

    [[nodiscard]] const std::set<TreeTile>& tiles() const { return tiles_; }
    /// As edge_moves().
    [[nodiscard]] const std::vector<EdgeMove>& moves(TreeTile tile) const {
        return edges_.at(tile).moves;
    }
    /// The tiles that share samples with this one.
    [[nodiscard]] const std::vector<TreeTile>& touching(TreeTile tile) const {
        return edges_.at(tile).touching;
    }
    /// The border vertices of other tiles that this one needs: the target of its move, and those
    /// at its own place.
    [[nodiscard]] std::vector<TreeVertex> partners(const TreeVertex& vertex) const;

private:
    struct TileEdges {
        std::vector<EdgeMove> moves;
        std::unordered_map<int, TreeVertex> moved; // by number_of() the vertex
        std::vector<TreeTile> touching;
    };
    // Row after row.
    [[nodiscard]] int number_of(const TreeVertex& vertex) const {
        return vertex.vertex.y * (tree_.cells(vertex.tile).x + 1) + vertex.vertex.x;
    }

    TileTree tree_;
    std::set<TreeTile> tiles_;
    std::map<TreeTile, TileEdges> edges_;
};

/// The vertices (col, row) where a view splits the border of a heightfield that is one tile.
/// Precondition: at most tile_cells cells a side.
std::vector<glm::ivec2> border_splits(const Bisection& bisection, const ErrorView& view);

using BorderSplits = std::map<TreeTile, std::vector<glm::ivec2>>;
/// 1 at the vertices of each tile where its bisection must split.
using SharedSplits = std::map<TreeTile, Grid<std::uint8_t>>;

/// The smallest set of splits that contains `required`, all parents, and each border vertex for
/// both tiles that meet there. So tiles meet without cracks, whatever their levels and views.
/// Precondition: `required` has an entry for each tile.
SharedSplits shared_splits(const TileTree& tree, const DrawnTiles& cover,
                           const BorderSplits& required);

} // namespace reljef::terrain
