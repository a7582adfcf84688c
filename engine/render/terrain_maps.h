#pragma once

#include <optional>

#include <glm/mat3x3.hpp>

#include "engine/core/color.h"
#include "engine/scene/scene.h"
#include "engine/scene/terrain_node.h"

namespace reljef::render {

/// The sun over a terrain whose node may be turned or scaled.
struct TerrainLight {
    scene::Light sun;
    glm::dmat3 world_from_local{1.0};

    friend bool operator==(const TerrainLight&, const TerrainLight&) = default;
};

/// What every place of a terrain sends to the eye, whichever way it looks (Lambert): its albedo
/// (its imagery over the hypsometric tint) times the sun, as far as the terrain around does not
/// hide it, and the sky. sRGB, opaque; the albedo alone without a light. As fine as the finer of
/// imagery and heights, but no side longer than `largest_side`; outermost texels are the outermost
/// samples.
Image lit_map(const scene::TerrainSurface& surface, const std::optional<TerrainLight>& light,
              int largest_side);

} // namespace reljef::render
