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
/// As in Irrlicht for patches of 17² samples.
inline constexpr int max_patch_levels = 4;

/// The level of each patch, 0 (finest) to levels - 1. As in the terrain node of Irrlicht 1.8, level
/// i begins 17 √(dx dy) (i + 1 + ⌊i/2⌋) metres from `eye` (scene metres) to the patch's middle.
/// Precondition: levels >= 1.
Grid<std::uint8_t> patch_levels(const Heightfield& heightfield, const Placement& placement,
                                glm::dvec3 eye, int levels);

/// The triangles of a tile's patches. A patch of level i has a vertex at every 2^i-th sample. It
/// takes the border vertices of coarser neighbours. `levels` is patch_levels() of the heightfield.
Triangulation triangulate_patches(const Grid<std::uint8_t>& levels, const TileCells& tile);

} // namespace reljef::terrain
