#pragma once

#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/core/grid.h"
#include "engine/material/cone_map.h"
#include "engine/scene/graph/terrain_node.h"

namespace reljef::render {

/// The search space of a surface over a plane: x column, y row, z height, 0 the lowest and 1 the
/// highest. An affine image of the local frame.
struct ReliefSpace {
    glm::dmat3 space_from_local{1.0}; ///< directions
    glm::dvec3 space_of_origin{0.0};  ///< where the local origin lies
    glm::vec3 metres_per_unit{1.0F};  ///< along each axis, exaggeration included
    double lowest = 0.0;              ///< metres
    double range = 1.0;               ///< metres, > 0
    Box box;       ///< of the search space: the samples, and a little above and below the heights
    Box local_box; ///< the same, metres
};
/// Precondition: the placement is plane.
ReliefSpace relief_space(const scene::TerrainSurface& surface);

/// Greatest heights, in [0,1] of the range, of blocks of 2^level cells a side: what a texture's mip
/// chain holds. Level 0 has a power of two of cells a side, at least as many as there are; beyond
/// the last one is 0.
std::vector<Grid<float>> max_mipmap(GridView<const float> relief_heights);

/// The plain (x) and the relaxed (y) cone of each cell; the last column and row, where there is no
/// cell any more, have their neighbours'.
Grid<glm::vec2> cone_texels(const material::ConeMaps& cones);

} // namespace reljef::render
