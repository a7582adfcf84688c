#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include "engine/scene/graph/terrain_node.h"

namespace reljef::scene {

/// An upright ellipsoid, round as seen from above; metres, > 0.
struct Ellipsoid {
    double radius = 0.4;
    double half_height = 0.9;
};

/// Where an ellipsoid touches the ground if it is moved along the local vertical.
struct GroundContact {
    double lift = 0.0;      ///< metres upwards until it touches; negative: it is above the ground
    glm::dvec3 normal{0.0}; ///< unit, of the ellipsoid where it touches, from there to its centre
};

/// Exact for the bilinear surface, of the finest loaded tiles of a streamed terrain; where levels
/// meet, the higher one counts. The curvature of the Earth below the ellipsoid does not count, nor
/// what lies across the seam of a globe. `center`: local metres of the terrain. Empty beside the
/// terrain, and if the centre is not finite.
std::optional<GroundContact> ground_contact(const TerrainNode& terrain, const Ellipsoid& ellipsoid,
                                            glm::dvec3 center);

} // namespace reljef::scene
