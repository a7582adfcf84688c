#pragma once

#include <cstdint>

#include "engine/core/grid.h"

namespace reljef::scene {

/// Heights at a tile's vertices and one step around them.
struct FilledHeights {
    Grid<float> heights;         ///< metres, all finite
    Grid<std::uint8_t> was_void; ///< 1: filled; empty: none
};

/// Fills voids (not finite) so that they join the heights around them without steps: with `coarse`,
/// heights of an overview at the same places, corrected by how far known heights are from it. The
/// correction is linear along the tile's border, and depends there on that side of the border
/// alone, so neighbours of a level agree; inside it is harmonic. At corners there is none. What
/// fills vertices is between the lowest and the highest of known and of filling coarse heights.
/// Precondition: equal sizes, at least 2 vertices a side; `coarse` is finite.
FilledHeights fill_tile_voids(Grid<float> heights, const Grid<float>& coarse);

} // namespace reljef::scene
