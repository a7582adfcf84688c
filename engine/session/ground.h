#pragma once

#include <optional>
#include <string>
#include <string_view>

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
double min_clearance(const TerrainScene& scene);

/// Raises the camera, and what it looks at, along the place's own vertical to the least clearance.
/// Returns by how many metres; 0 where it stays, and beside the terrain.
double keep_above_ground(TerrainScene& scene);

/// How a camera that stands below the ground comes to stand above it. Scene metres along the
/// place's own vertical, the exaggeration included.
struct Lift {
    double depth = 0.0;  ///< below the ground
    double metres = 0.0; ///< from there up; 0: the camera stays
    glm::dvec3 way{0.0}; ///< the same as a step in the scene, for the eye and what it looks at
    explicit operator bool() const { return metres > 0.0; }
};

/// An eye less than this below the ground stands on it, metres: scene coordinates lose as much by
/// rounding.
inline constexpr double ground_rounding = 1e-3;

/// Lifts an eye below the ground to at least `clearance` metres above all that may be drawn there,
/// along its own vertical. An eye on or above the ground, beside the terrain, or over a void stays.
/// The ground is that of the finest tile that is there, and of the overview before.
Lift lift_of(const scene::TerrainNode& terrain, glm::dvec3 eye, double clearance);

/// Lifts the scene's camera, with what it looks at, by the ground that is there. A map (an
/// orthographic camera) stays.
Lift lift_camera(TerrainScene& scene);

/// The message about a lift: "--eye: 12.3 m below the ground: lifted to 0.5 m above it;
/// --allow-underground keeps it". `what` names the option, or the file with its key.
std::string lift_note(const Lift& lift, std::string_view what);

} // namespace reljef::session
