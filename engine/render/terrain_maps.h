#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include "engine/core/color.h"
#include "engine/scene/terrain_node.h"

namespace reljef::render {

/// Albedo of a terrain (its imagery over the hypsometric tint) with the share of the sun that each
/// place sees in the alpha channel; without a sun alpha is 255. No side is longer than
/// `largest_side`.
Image color_map(const scene::TerrainSurface& surface, const std::optional<glm::dvec3>& to_sun,
                int largest_side);

/// Scene-frame gradients as pairs of half floats. No side is longer than `largest_side`.
Grid<std::uint32_t> gradient_map(const scene::TerrainSurface& surface, int largest_side);

} // namespace reljef::render
