#pragma once

#include <glm/vec2.hpp>

#include "engine/core/grid.h"

// The heights of a level from those of the next finer one. Private to tile_error.cpp.

namespace reljef::terrain {

/// What a loop writes: plain pointers that overlap nothing else. Otherwise checks of bounds and of
/// overlaps keep loops from becoming vector code.
using LoopOutput = float* __restrict;

/// The vertices of the coarser level that have all finer ones around them. Precondition: an odd
/// number of vertices a side.
Grid<float> coarser_heights(const Grid<float>& finer);

/// Copies the outermost vertices of a level (0 and `last`) to those outside; `first`: of the grid.
void repeat_border(Grid<float>& heights, glm::ivec2 first, glm::ivec2 last);

} // namespace reljef::terrain
