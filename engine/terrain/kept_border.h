#pragma once

#include <cstdint>

#include <glm/vec2.hpp>

#include "engine/core/grid.h"

namespace reljef::terrain {

/// Of the vertices of a tile of so many cells a side, at most tile_cells, 1 where the bisection of
/// the tile must split for each vertex of its border to be there: those, and the splits that they
/// need.
Grid<std::uint8_t> splits_of_border(glm::ivec2 cells);

} // namespace reljef::terrain
