#pragma once

#include <cstdint>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/color.h"
#include "engine/scene/streaming/light.h"
#include "engine/scene/streaming/terrain_surface.h"

namespace reljef::scene {

/// The sun over a terrain, and the transform of its node.
struct TerrainLight {
    Light sun;
    glm::dmat3 world_from_local{1.0};

    friend bool operator==(const TerrainLight&, const TerrainLight&) = default;
};

/// The imagery over the hypsometric tint, and the overlay over both, sRGB, opaque. Its outermost
/// texels are the outermost samples.
Image albedo_map(const TerrainSurface& surface);

/// Linear radiance at albedo 1 from the sky and the sun.
struct IrradianceParts {
    glm::vec3 sky{0.0F};
    glm::vec3 sun{0.0F}; ///< without shadows; 0 while the sun is below the horizon
};

/// Linear Lambertian radiance of a terrain at albedo 1: the sun with the terrain's shadows, and the
/// sky.
class TerrainIrradiance {
public:
    TerrainIrradiance(const TerrainSurface& surface, const TerrainLight& light);

    /// Slope and visibility are bilinear between samples. `sample`: col, row inside the
    /// heightfield.
    [[nodiscard]] glm::vec3 at(glm::dvec2 sample) const;

    /// A unit vector of the local frame, such as a normal, in the world.
    [[nodiscard]] glm::vec3 in_world(glm::vec3 normal) const;
    /// For a finer tile of the same terrain: its normal and up (unit vectors of the world), and the
    /// visible share of the sun.
    [[nodiscard]] glm::vec3 at(glm::vec3 normal, glm::vec3 up, float visibility,
                               float openness = 1.0F) const;
    /// For callers that compute shadows themselves.
    [[nodiscard]] IrradianceParts parts_at(glm::vec3 normal, glm::vec3 up,
                                           float openness = 1.0F) const;
    /// Light of the sky as a share of that which a place of this slope has on a free plane.
    [[nodiscard]] float openness(glm::dvec2 sample) const;
    /// The share of the sun that the terrain does not hide, [0, 1].
    [[nodiscard]] float visibility(glm::dvec2 sample) const;

    /// For callers that compute shadows themselves.
    [[nodiscard]] IrradianceParts parts_at(glm::dvec2 sample) const;

private:
    [[nodiscard]] glm::vec3 normal_at(glm::dvec2 sample) const;
    [[nodiscard]] float sky_at(glm::dvec2 sample, glm::vec3 normal) const;

    Grid<std::uint8_t> sky_share_; // empty: nothing hides the sky
    Grid<std::uint8_t> visibility_;
    Grid<glm::vec2> gradients_;
    glm::mat3 world_from_normal_;
    glm::vec3 to_sun_;
    glm::vec3 sun_;
    glm::vec3 sky_;
    bool is_day_;
};

} // namespace reljef::scene
