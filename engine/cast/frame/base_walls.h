#pragma once

#include <vector>

#include "engine/cast/packet/block_kernel.h"
#include "engine/view/draw_list.h"

namespace reljef::cast {

/// The walls below the terrains of a list, for each block of the picture (for_each_block); empty
/// without such walls. A wall
/// that faces the eye is in front of all ground: the eye is outside, and the terrain's outline is
/// convex.
std::vector<std::vector<WallTriangle>> base_walls(const view::DrawList& list);

} // namespace reljef::cast
