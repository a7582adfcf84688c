#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/grid.h"
#include "engine/terrain/mesh/triangle_error.h"

namespace reljef::bench {

/// Of the samples of a triangle, any three, the one farthest from its plane.
struct FarthestSample {
    glm::ivec2 sample{0};
    double error = 0.0; ///< vertically, in the heights' unit
};
FarthestSample farthest_sample(GridView<const float> heights,
                               const terrain::SampleTriangle& triangle);

/// The Delaunay triangulation that begins with two triangles and takes in the sample that is
/// farthest off, until none is farther than `error` (Garland and Heckbert 1995, "Fast polygonal
/// approximation of terrains and height fields"). Precondition: at least 2×2 heights, error >= 0.
std::vector<terrain::SampleTriangle> greedy_triangulation(GridView<const float> heights,
                                                          double error);

} // namespace reljef::bench
