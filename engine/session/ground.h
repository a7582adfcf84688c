#pragma once

#include <optional>

#include "engine/scene/motion/free_flight.h"
#include "engine/session/scene_setup.h"

namespace reljef::session {

// The ground that is there: of the finest tile where the terrain is read part by part.

/// Of an eye, true metres along the place's own vertical; nothing beside the terrain.
std::optional<double> height_above_ground(const scene::TerrainNode& terrain, glm::dvec3 eye);

/// What is straight below or above x, y, with the highest that any triangulation has there.
std::optional<scene::GroundAt> ground_at(const scene::TerrainNode& terrain, double x, double y);

/// Of the picture's middle, metres from pixel to pixel across the view; nothing where it shows no
/// ground.
std::optional<double> metres_per_pixel(const scene::TerrainNode& terrain,
                                       const scene::Camera& camera, int pixels_high);

/// How far an eye stays above all that may be drawn below it, metres: less on small terrains.
double least_clearance(const TerrainScene& scene);

/// Raises the camera, and what it looks at, along the place's own vertical to the least clearance.
/// Returns by how many metres; 0 where it stays, and beside the terrain.
double keep_above_ground(TerrainScene& scene);

} // namespace reljef::session
