#pragma once

#include <optional>

#include <glm/mat4x4.hpp>

#include "engine/scene/graph/camera.h"
#include "engine/scene/graph/mesh.h"
#include "engine/scene/graph/terrain_node.h"

namespace reljef::scene {

/// Where the walls of a block end, true metres: 4 % of the shorter side below the lowest height.
double block_bottom(const TerrainSurface& surface);

/// Walls from the border of a terrain down to `bottom`, true metres: it looks like a piece that was
/// cut out of the Earth. Seen from outside; without a bottom. Empty if the border is nowhere higher
/// or the terrain goes around the Earth. A wall has a vertex at every sample of the border.
std::optional<Mesh> terrain_base(const TerrainSurface& surface, double bottom);

/// Whether a camera may see such walls: not from over the terrain, where all of them face away.
bool may_show_base(const TerrainSurface& surface, const glm::dmat4& world_from_local,
                   const Camera& camera);

} // namespace reljef::scene
