#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/cast/tile_nodes.h"
#include "engine/terrain/field/tile_lattice.h"
#include "engine/terrain/tree/tile_tree.h"

namespace reljef::cast {

/// A part of a streamed tile whose cells have one size: its last cells, and those at a pole, may be
/// shorter. Samples are those of the terrain with even rows (geo::WrappedRows::even_row).
struct TilePiece {
    glm::ivec2 vertex{0}; ///< the first, of the tile
    glm::ivec2 cells{1};
    glm::dvec2 first{0.0}; ///< sample
    glm::dvec2 step{1.0};  ///< of a cell, samples
    unsigned walls = 0;    ///< sides that are not the terrain's (block_kernel.h)
    glm::ivec2 part{0};    ///< among the pieces of the tile, from the west and from the north
};

inline constexpr glm::ivec2 max_tile_parts(2, 3);

/// The pieces of a tile, in the order in which rays from a sample pass them; `from`: on a plane.
/// `last`: the terrain's last sample, without even rows.
std::vector<TilePiece> pieces_of(const terrain::TileLattice& tile, glm::dvec2 last,
                                 glm::dvec2 from);

/// The indices of drawn tiles, in the order in which rays pass them. `from`: where all rays begin,
/// samples of the tree; infinite for parallel rays.
std::vector<std::size_t> front_to_back(const terrain::TileTree& tree,
                                       std::span<const terrain::TreeTile> drawn, glm::dvec2 from);

/// Adds the nodes of a drawn tile; returns the index of the first.
using TileAdder = std::function<int(std::size_t drawn, TileNodes& nodes)>;

/// The tree of drawn tiles. `first_of`: the first corner of a tile, in samples
/// of the rays.
TileNodes nodes_of(const terrain::TileTree& tree, std::span<const terrain::TreeTile> drawn,
                   const std::function<glm::dvec2(terrain::TreeTile)>& first_of,
                   const TileAdder& add_tile);

/// The index of a tile's first node. Adds `boxes`, the nodes of its pieces with TileNode::tile, and
/// nodes over them. They are in the order of pieces_of() from the first sample.
int add_piece_nodes(std::span<const TilePiece> pieces, std::span<const TileNode> boxes,
                    TileNodes& nodes);

/// A node of others. `parts`: TileNode::parts.
TileNode node_over(const TileNodes& nodes, const std::array<int, 4>& parts, glm::dvec2 lines);

} // namespace reljef::cast
