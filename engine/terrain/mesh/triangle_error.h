#pragma once

#include <array>

#include <glm/vec2.hpp>

#include "engine/core/grid.h"

namespace reljef::terrain {

/// Three samples (col, row) whose edges run along columns, rows or diagonals of cells.
using SampleTriangle = std::array<glm::ivec2, 3>;

/// The greatest vertical distance between a triangle through three samples and the bilinear
/// surface, over every point of the triangle, in the heights' unit. Exact but for the rounding of
/// doubles. Precondition: the samples are on the grid and span a triangle.
double triangle_error(GridView<const float> heights, const SampleTriangle& triangle);

} // namespace reljef::terrain
