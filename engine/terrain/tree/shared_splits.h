#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/grid.h"
#include "engine/terrain/mesh/bisection_mesh.h"
#include "engine/terrain/tree/tile_cover.h"

namespace reljef::terrain {

/// Where the bisection of a heightfield that is one tile splits its border for a view: vertices
/// (col, row). Precondition: at most tile_cells cells a side.
std::vector<glm::ivec2> border_splits(const Bisection& bisection, const ErrorView& view);

/// By tile of a cover.
using BorderSplits = std::map<TreeTile, std::vector<glm::ivec2>>;
/// Of the vertices of each tile of a cover, 1 where its bisection must split.
using SharedSplits = std::map<TreeTile, Grid<std::uint8_t>>;

/// The fewest splits with those in `wanted` and all that they need, where each border vertex is
/// there for both tiles that meet at it: so the tiles meet vertex on vertex, whatever their levels
/// and the views that they were cut for. Precondition: a row in `wanted` for each tile.
SharedSplits shared_splits(const TileTree& tree, const TileCover& cover,
                           const BorderSplits& wanted);

} // namespace reljef::terrain
