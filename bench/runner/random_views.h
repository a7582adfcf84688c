#pragma once

#include <random>

#include "engine/scene/graph/camera.h"
#include "engine/scene/graph/terrain_node.h"

namespace reljef::bench {

/// Where anyone might look at a terrain from: in or beside it, from a fiftieth of its width times
/// 0.37 to 20 above the ground, towards somewhere on it; every third with a field of view of its
/// own, 10 to 120 degrees. `near` is kept.
scene::Camera random_view(std::mt19937& random, const scene::TerrainSurface& surface, double near);

} // namespace reljef::bench
