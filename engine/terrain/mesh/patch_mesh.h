#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "engine/core/grid.h"
#include "engine/terrain/field/heightfield.h"
#include "engine/terrain/field/placement.h"
#include "engine/terrain/mesh/bisection_mesh.h"
#include "engine/terrain/mesh/tile_layout.h"

namespace reljef::terrain {

/// Cells along a patch's side: 17² samples.
inline constexpr int patch_cells = 16;
/// Levels beyond are not used, as Irrlicht uses none for patches of 17 samples.
inline constexpr int max_patch_levels = 4;

/// The level of detail of each patch of a heightfield, patch row after patch row: 0 finest, below
/// `levels`, by the distance of its middle from `eye` (scene metres) alone, as the terrain node of
/// Irrlicht 1.8 chooses: level i from 17 √(dx dy) (i + 1 + ⌊i/2⌋) metres on.
/// Precondition: levels >= 1.
Grid<std::uint8_t> patch_levels(const Heightfield& heightfield, const Placement& placement,
                                glm::dvec3 eye, int levels);

/// A tile's patches, each of level i with every 2^i-th sample a vertex. Where a neighbour is
/// coarser the border takes its vertices, so that they meet edge to edge. `levels` is
/// patch_levels() of the whole heightfield.
Triangulation triangulate_patches(const Grid<std::uint8_t>& levels, const Tile& tile);

} // namespace reljef::terrain
