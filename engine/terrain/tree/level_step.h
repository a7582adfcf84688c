#pragma once

#include <glm/vec2.hpp>

#include "engine/core/grid.h"

// The heights of a level from those of the next finer one. Private to tile_error.cpp.

namespace reljef::terrain {

/// The vertices of the coarser level that have all finer ones around them. Precondition: an odd
/// number of vertices a side.
Grid<float> coarser_heights(const Grid<float>& finer);

/// Copies the outermost vertices of a level (0 and `last`) to those outside; `first`: of the grid.
void repeat_border(Grid<float>& heights, glm::ivec2 first, glm::ivec2 last);

} // namespace reljef::terrain
