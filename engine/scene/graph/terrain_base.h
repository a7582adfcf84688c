#pragma once

#include <optional>

#include "engine/scene/graph/mesh.h"
#include "engine/scene/graph/terrain_node.h"

namespace reljef::scene {

/// Walls from the border of a terrain down to below its lowest height: it looks like a piece that
/// was cut out of the Earth. Seen from outside; without a bottom. Empty if the terrain goes around
/// the Earth. A wall has a vertex at every sample of the border.
std::optional<Mesh> terrain_base(const TerrainSurface& surface);

} // namespace reljef::scene
