#pragma once

#include <optional>

#include "engine/core/color.h"
#include "engine/scene/terrain_light.h"

namespace reljef::render {

/// What every place of a terrain sends to the eye, whichever way it looks: its albedo times its
/// irradiance (scene/terrain_light.h). sRGB, opaque; the albedo alone without a light. As fine as
/// the finer of imagery and heights, but no side longer than `largest_side`; outermost texels are
/// the outermost samples.
Image lit_map(const scene::TerrainSurface& surface, const std::optional<scene::TerrainLight>& light,
              int largest_side);

/// The same in two parts for those who find out themselves what the sun sees: what the sky lights,
/// and what the sun would if nothing hid it.
struct LightParts {
    Image sky;
    Image sun;
};
LightParts light_parts(const scene::TerrainSurface& surface, const scene::TerrainLight& light,
                       int largest_side);

} // namespace reljef::render
