#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "engine/scene/motion/free_flight.h"
#include "engine/session/scene_setup.h"

namespace reljef::session {

// All functions use the finest loaded tiles of a streamed terrain.

/// Eye height above ground, true metres along the local vertical; empty off the terrain.
std::optional<double> height_above_ground(const scene::TerrainNode& terrain, glm::dvec3 eye);

/// The ground below an eye, with the highest point that any triangulation has there; empty off the
/// terrain.
std::optional<scene::GroundBelow> ground_below(const scene::TerrainNode& terrain, glm::dvec3 eye);
/// The eye, lifted along the local vertical to `clearance` metres above everything drawn below it.
glm::dvec3 above_ground(const scene::TerrainNode& terrain, glm::dvec3 eye, double clearance);

/// A note on an ellipsoid if heights may need a geoid that is neither applied nor excluded by the
/// user, or if the geoid is not the one that they count from.
std::optional<std::string> geoid_note(const TerrainScene& scene, const SourceOptions& terrain);

/// What a ray of the viewer meets first.
struct PickedPlace {
    glm::dvec3 world{0.0};
    std::string object = {}; ///< its name; empty: the ground
    glm::dvec3 normal{0.0};  ///< of an object's face: outwards, unit
};
/// The ground, or an object or model before it; empty: the sky.
std::optional<PickedPlace> pick_place(const TerrainScene& scene, const Ray& ray);

/// Height of a picked place, true metres: exaggeration lifts the ground, and objects as a whole.
/// Beside the terrain, and outside of the placement's domain, its z.
double height_of(const scene::TerrainNode& terrain, const PickedPlace& place);

/// Metres per pixel at the middle of the picture, across the view; empty if it shows no ground.
std::optional<double> metres_per_pixel(const scene::TerrainNode& terrain,
                                       const scene::Camera& camera, int pixels_high);

/// Smallest height of an eye above everything drawn below it, metres; smaller on small terrains.
double min_clearance(const TerrainScene& scene);

/// Raises the camera and its target along the local vertical to the smallest clearance. Returns the
/// distance in metres; 0 if the camera stays, and off the terrain.
double keep_above_ground(TerrainScene& scene);

/// The lift of a camera from below the ground: scene metres along the local vertical.
struct Lift {
    double depth = 0.0;  ///< below the ground
    double metres = 0.0; ///< upwards; 0: the camera stays
    glm::dvec3 way{0.0}; ///< the same as a vector
    explicit operator bool() const { return metres > 0.0; }
};

/// Lifts an eye below the ground to `clearance` metres above everything drawn there. No lift for an
/// eye on or above the ground, off the terrain or over a void.
Lift lift_of(const scene::TerrainNode& terrain, glm::dvec3 eye, double clearance);

/// Lifts the scene's camera and its target above the ground. Orthographic cameras stay.
Lift lift_camera(TerrainScene& scene);

/// "--eye: 12.3 m below the ground: lifted to 0.5 m above it; --allow-underground keeps it".
/// `what`: the option, or the file with its key.
std::string lift_note(const Lift& lift, std::string_view what);

} // namespace reljef::session
