#pragma once

#include <memory>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "engine/core/color.h"
#include "engine/core/grid.h"
#include "engine/scene/graph/terrain_light.h"
#include "engine/scene/tile_stream.h"

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

/// The light of a terrain that is to be made before it is drawn.
struct LightRequest {
    std::shared_ptr<const scene::TerrainSurface> surface; ///< the overview of a streamed terrain
    std::shared_ptr<scene::TileStream> stream;            ///< null: the terrain is in memory
    scene::TerrainLight light;
    bool in_parts = false; ///< light_parts() instead of lit_map()
    int largest_side = 0;  ///< of the maps, texels
};

/// Light that was made before it is drawn, with what it was made for.
struct PreparedLight {
    LightRequest request;
    Image lit; ///< or the sky's part; empty for a streamed terrain
    Image sun; ///< the sun's part, else empty
    std::shared_ptr<const scene::TerrainIrradiance>
        irradiance; ///< of a streamed terrain, else null
};

/// Makes the light; on any thread.
PreparedLight prepare_light(LightRequest request);

/// What a tile of detail on a terrain is lit by: its albedo, sRGB, and, in local directions, its
/// normals (xyz), with the share of the sun's disc that the terrain around leaves (w; 1 without a
/// light). Both of one size, as lit_map's.
struct GroundMap {
    Image albedo;
    Grid<glm::vec4> surface;
};
GroundMap ground_map(const scene::TerrainSurface& surface,
                     const std::optional<scene::TerrainLight>& light, int largest_side);

/// How sample coordinates of a heightfield become texture coordinates, sample · xy + zw, where the
/// outermost centres of texels are the outermost samples.
glm::vec4 texture_from_sample(glm::ivec2 samples, glm::ivec2 texels);

} // namespace reljef::render
