#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace reljef::scene {

/// A light so far away that its rays are parallel.
struct Light {
    double azimuth = 300.0; ///< degrees clockwise from north, towards the light
    double altitude = 40.0; ///< degrees above the horizon
    // Linear radiance of a surface with albedo 1 that faces the light, or the sky.
    glm::vec3 color{1.70F, 1.60F, 1.43F};
    glm::vec3 ambient{0.30F, 0.35F, 0.44F};
    /// Terrain hides the sky from itself (terrain/light/sky_share.h), not only its own half.
    bool is_sky_hidden = false;

    friend bool operator==(const Light&, const Light&) = default;
};

glm::dvec3 to_light(const Light& light);

/// The light rotated by its node's transform.
Light turned(Light light, const glm::dmat4& world_from_local);

} // namespace reljef::scene
