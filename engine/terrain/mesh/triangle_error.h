#pragma once

#include <array>

#include <glm/vec2.hpp>

#include "engine/core/grid.h"

namespace reljef::terrain {

/// Three samples (col, row) whose edges run along columns, rows or diagonals of cells.
using SampleTriangle = std::array<glm::ivec2, 3>;

/// Largest vertical distance between a triangle and the bilinear surface, in the heights' unit.
/// Exact except for rounding. Precondition: the samples are on the grid and span a triangle.
double triangle_error(GridView<const float> heights, const SampleTriangle& triangle);

} // namespace reljef::terrain
