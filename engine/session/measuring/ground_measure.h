#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/core/result.h"
#include "engine/scene/graph/terrain_node.h"
#include "engine/session/ground.h"
#include "engine/terrain/measure/profile.h"
#include "engine/terrain/measure/surface_point.h"

namespace reljef::session {

// What the viewer measures on the ground, on the finest loaded tiles of a streamed terrain. Heights
// and distances are true metres, whatever the exaggeration.

/// The ground below or above a world place: its slope and aspect are those of the cell.
std::optional<terrain::SurfacePoint> ground_point(const scene::TerrainNode& terrain,
                                                  glm::dvec3 world);

/// "46.12345, 8.12345: height 1234.5 m, slope 23.4°, aspect 145°"; x and y without a place on
/// Earth. On an object: "…: height 1250.0 m on 'tower', 15.5 m above the ground".
std::string point_text(const scene::TerrainNode& terrain, const PickedPlace& place);

/// The ground between two world places: along the geodesic, or straight over a plane without a
/// place on Earth. At most `max_points` points, else half a sample apart. NaN in voids and off the
/// terrain.
Result<std::vector<terrain::ProfilePoint>> ground_profile(const scene::TerrainNode& terrain,
                                                          glm::dvec3 from, glm::dvec3 to,
                                                          int max_points = 20'000);

/// What hides `to` from `from`: where the straight line first enters the ground or an object; empty
/// if nothing does. Both are lifted by `height` metres, and moved out of the face of the object
/// that they are on, so that a wall does not hide its own points from those before it.
std::optional<PickedPlace> hidden_by(const TerrainScene& scene, const PickedPlace& from,
                                     const PickedPlace& to, double height);

} // namespace reljef::session
