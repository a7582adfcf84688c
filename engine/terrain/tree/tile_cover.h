#pragma once

#include <map>
#include <set>
#include <unordered_map>
#include <vector>

#include "engine/terrain/tree/tile_edges.h"

namespace reljef::terrain {

/// Tiles of a tree that are drawn together, and where they meet.
class TileCover {
public:
    /// Preconditions: as edge_moves() for each of `drawn`.
    TileCover(const TileTree& tree, std::set<TreeTile> drawn);

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

} // namespace reljef::terrain
