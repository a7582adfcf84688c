#pragma once

#include <cstdint>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/color.h"
#include "engine/scene/graph/scene.h"
#include "engine/scene/graph/terrain_node.h"

namespace reljef::scene {

/// The sun over a terrain whose node may be turned or scaled.
struct TerrainLight {
    Light sun;
    glm::dmat3 world_from_local{1.0};

    friend bool operator==(const TerrainLight&, const TerrainLight&) = default;
};

/// The colour of the terrain itself: its imagery over the hypsometric tint, sRGB, opaque. Its
/// outermost texels are the outermost samples.
Image albedo_map(const TerrainSurface& surface);

/// What a place reflects at albedo 1, linear.
struct IrradianceParts {
    glm::vec3 sky{0.0F};
    glm::vec3 sun{0.0F}; ///< as if nothing hid it; nothing from below the terrain's horizon
};

/// What every place of a terrain reflects at albedo 1, whichever way one looks (Lambert): the sun,
/// as far as the terrain around does not hide it, and the sky.
class TerrainIrradiance {
public:
    /// Finds slope and visibility of the sun at every sample.
    TerrainIrradiance(const TerrainSurface& surface, const TerrainLight& light);

    /// Linear; slope and visibility are bilinear between samples. `sample`: col, row inside the
    /// heightfield.
    [[nodiscard]] glm::vec3 at(glm::dvec2 sample) const;

    /// The same where the surface's normal, its own up (both unit vectors of the local frame) and
    /// the share of the sun that it sees are known: of a tile of the same terrain that is finer.
    [[nodiscard]] glm::vec3 at(glm::vec3 normal, glm::vec3 up, float visibility) const;
    /// Share of the sun that the terrain around leaves to a place, [0, 1].
    [[nodiscard]] float visibility(glm::dvec2 sample) const;

    /// The same for those who find out themselves what the sun sees.
    [[nodiscard]] IrradianceParts parts_at(glm::dvec2 sample) const;

private:
    [[nodiscard]] glm::vec3 normal_at(glm::dvec2 sample) const;

    Grid<glm::vec2> gradients_;
    Grid<std::uint8_t> visibility_;
    glm::mat3 world_from_normal_;
    glm::vec3 to_sun_;
    glm::vec3 sun_;
    glm::vec3 sky_;
    bool is_day_;
};

} // namespace reljef::scene
