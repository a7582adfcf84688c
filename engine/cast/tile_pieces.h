#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/terrain/field/tile_lattice.h"
#include "engine/terrain/tree/tile_tree.h"

namespace reljef::cast {

/// A part of a streamed tile whose cells have one size: its last cells may be shorter.
struct TilePiece {
    glm::ivec2 vertex{0}; ///< the first, of the tile
    glm::ivec2 cells{1};
    glm::dvec2 first{0.0}; ///< sample of the terrain
    glm::dvec2 step{1.0};  ///< of a cell, samples of the terrain
    unsigned walls = 0;    ///< sides that are not the terrain's (block_kernel.h)
};

/// The pieces of a tile, in the order in which rays from a sample pass them. `last`: sample of the
/// terrain.
std::vector<TilePiece> pieces_of(const terrain::TileLattice& tile, glm::dvec2 last,
                                 glm::dvec2 from);

/// The indices of drawn tiles, in the order in which rays pass them. `from`: where all rays begin,
/// samples of the tree; infinite for parallel rays.
std::vector<std::size_t> front_to_back(const terrain::TileTree& tree,
                                       std::span<const terrain::TreeTile> drawn, glm::dvec2 from);

} // namespace reljef::cast
