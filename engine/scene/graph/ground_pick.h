#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/scene/graph/terrain_node.h"

namespace reljef::scene {

/// Where a ray meets the ground.
struct GroundHit {
    double t = 0.0;         ///< along the ray
    glm::dvec3 world{0.0};  ///< local metres of the terrain
    glm::dvec3 sample{0.0}; ///< col and row of the surface, height in true metres
};

/// The first place where a ray in local metres enters the ground: exactly, on the finest loaded
/// tiles of a streamed terrain. Waits for nothing. At the borders of tiles of different levels it
/// may pass where their heights differ. Empty if the ray misses the ground or is not finite.
std::optional<GroundHit> pick_ground(const TerrainNode& terrain, const Ray& ray);

} // namespace reljef::scene
