#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "engine/scene/motion/free_flight.h"
#include "engine/session/scene_setup.h"

namespace reljef::session {

// Queries of the ground: of the finest loaded tile of a streamed terrain.

/// Eye height above ground, true metres along the local vertical; empty off the terrain.
std::optional<double> height_above_ground(const scene::TerrainNode& terrain, glm::dvec3 eye);

/// The ground at x, y, with the highest point that any triangulation has there.
std::optional<scene::GroundAt> ground_at(const scene::TerrainNode& terrain, double x, double y);

/// Metres per pixel at the middle of the picture, across the view; empty if it shows no ground.
std::optional<double> metres_per_pixel(const scene::TerrainNode& terrain,
                                       const scene::Camera& camera, int pixels_high);

/// Smallest height of an eye above everything that may be drawn below it, metres. Less on small
/// terrains.
double min_clearance(const TerrainScene& scene);

/// Raises the camera and its target along the local vertical to the smallest clearance. Returns by
/// how many metres; 0 if it stays, and off the terrain.
double keep_above_ground(TerrainScene& scene);

/// The lift of a camera from below the ground. Scene metres along the local vertical, exaggeration
/// included.
struct Lift {
    double depth = 0.0;  ///< below the ground
    double metres = 0.0; ///< from there up; 0: the camera stays
    glm::dvec3 way{0.0}; ///< the same as a step in the scene, for the eye and what it looks at
    explicit operator bool() const { return metres > 0.0; }
};

/// An eye less than this below the ground stands on it, metres: scene coordinates lose as much by
/// rounding.
inline constexpr double ground_rounding = 1e-3;

/// The lift of an eye below the ground to at least `clearance` metres above everything that may be
/// drawn there, along the local vertical. None for an eye on or above the ground, off the terrain
/// or over a void. Before finer tiles are loaded, the ground is that of the overview.
Lift lift_of(const scene::TerrainNode& terrain, glm::dvec3 eye, double clearance);

/// Lifts the scene's camera and its target above the ground that is loaded. Orthographic cameras
/// stay.
Lift lift_camera(TerrainScene& scene);

/// The message about a lift: "--eye: 12.3 m below the ground: lifted to 0.5 m above it;
/// --allow-underground keeps it". `what` names the option, or the file with its key.
std::string lift_note(const Lift& lift, std::string_view what);

} // namespace reljef::session
