#pragma once

#include <cstddef>
#include <span>

#include <glm/vec3.hpp>

#include "engine/scene/streaming/light.h"

namespace reljef::scene {

/// A lamp at the origin of its node, which shines the same in all directions. It casts no shadows.
/// The scale of its node has no effect.
struct PointLight {
    glm::vec3 color{1.0F}; ///< linear
    /// Linear radiance of a white surface that faces the light from a metre away; it falls with the
    /// square of the distance. >= 0
    float intensity = 25.0F;
    /// Metres; not above 0: it gives no light. The light ends at the range: it is multiplied by
    /// (1 − (distance / range)⁴)² (Karis 2013, "Real Shading in Unreal Engine 4"). May be infinite.
    float range = 50.0F;

    friend bool operator==(const PointLight&, const PointLight&) = default;
};

/// A point light in the world, metres.
struct PlacedPointLight {
    PointLight light;
    glm::dvec3 place{0.0};

    friend bool operator==(const PlacedPointLight&, const PlacedPointLight&) = default;
};

/// Metres to lights whose rays are parallel: as far as the Sun (IAU 2012, resolution B2). Over the
/// whole Earth the directions to them differ by less than 1e-4 radians.
inline constexpr double distance_of_parallel_light = 149'597'870'700.0;

/// The same light of Light::color, without limits of its range. Light::ambient is not in it.
PlacedPointLight as_point_light(const Light& light);

/// Maximum that a picture shows.
inline constexpr std::size_t max_shown_point_lights = 16;

/// Light grows no further towards a light than to this distance, metres.
inline constexpr float nearest_point_light = 0.01F;

/// Linear radiance at albedo 1, at a place of the world with a normal (unit vector).
glm::vec3 radiance_from(const PlacedPointLight& light, glm::dvec3 place, glm::vec3 normal);
/// Of all lights.
glm::vec3 radiance_from(std::span<const PlacedPointLight> lights, glm::dvec3 place,
                        glm::vec3 normal);

} // namespace reljef::scene
