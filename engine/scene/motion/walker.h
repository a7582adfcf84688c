#pragma once

#include <glm/vec3.hpp>

#include "engine/scene/motion/ground_contact.h"

namespace reljef::scene {

/// What walks on the ground: an ellipsoid that gravity pulls down.
struct WalkingBody {
    Ellipsoid shape;
    double gravity = 9.81; ///< metres a second²; 0: none
    double max_slope =
        45.0; ///< degrees, [0, 90): stands on such ground, and slides down steeper one
};

/// A body at a time. To let it jump, give it a velocity upwards.
struct Walker {
    glm::dvec3 center{0.0};   ///< of the ellipsoid, local metres of the terrain
    glm::dvec3 velocity{0.0}; ///< of falling and sliding, metres a second; walking is no part of it
    bool on_ground = false;   ///< stands; does not fall or slide

    friend bool operator==(const Walker&, const Walker&) = default;
};

/// The walker after a step of `seconds` along `way` (metres). It slides along what it meets, and
/// its ellipsoid ends above the ground. A walker that stands goes down slopes without falling.
/// Beside the terrain nothing stops it. A way of over a hundred radii may lead through a thin
/// ridge. What is not finite, and negative time, counts as 0.
Walker walked(const TerrainNode& terrain, const WalkingBody& body, const Walker& before,
              glm::dvec3 way, double seconds);

} // namespace reljef::scene
