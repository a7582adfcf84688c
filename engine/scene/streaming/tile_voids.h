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
/// heights of an overview at the same places, corrected by how far known heights are from it. Along
/// the tile's border the correction depends on that side alone, so neighbours of a level agree; it
/// fades within a few times `reach`, vertices, > 0, as what the overview lacks does in voids of
/// terrain in memory. Inside it is harmonic. At corners there is none. What fills vertices is
/// between the lowest and the highest of known and of filling coarse heights. Precondition: equal
/// sizes, at least 2 vertices a side; `coarse` is finite.
FilledHeights fill_tile_voids(Grid<float> heights, const Grid<float>& coarse, double reach);

} // namespace reljef::scene
