#pragma once

#include <glm/vec2.hpp>

#include "engine/core/grid.h"
#include "engine/terrain/tree/tile_tree.h"

// The heights of a level from those of the next finer one. Private to tile_error.cpp and
// tile_check.cpp.

namespace reljef::terrain {

/// What a loop writes: plain pointers that overlap nothing else. Otherwise checks of bounds and of
/// overlaps keep loops from becoming vector code.
using LoopOutput = float* __restrict;

/// A grid of vertices on a level of a tree.
struct PlacedVertices {
    const TileTree& tree;
    int level = 0;
    glm::ivec2 first{0}; ///< of the grid
};

/// Metres. A coarser vertex must not be a void beside a finer one that is none, and a pole has one
/// height at all levels: what is known nowhere near it does not depend on anything.
inline constexpr float height_of_void_pole = 0.0F;

/// The vertices of a level that have all vertices of the next finer one around them. `coarser`: of
/// the result. Those beyond the raster repeat its border; on a globe they are those of the other
/// side of the seam, and a row on a pole is the mean of that row alone, or height_of_void_pole.
/// Precondition: an odd number of vertices a side.
Grid<float> coarser_heights(const Grid<float>& finer, const PlacedVertices& coarser);

} // namespace reljef::terrain
