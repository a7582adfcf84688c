#pragma once

#include <memory>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "engine/core/color.h"
#include "engine/core/grid.h"
#include "engine/scene/streaming/terrain_light.h"
#include "engine/scene/streaming/tile_stream.h"

namespace reljef::view {

/// The terrain's diffuse reflection: albedo times irradiance (scene/terrain_light.h); without a
/// light the albedo. sRGB, opaque. Has the finer resolution of imagery and heights, sides up to
/// `largest_side`; outermost texels are the outermost samples.
Image lit_map(const scene::TerrainSurface& surface, const std::optional<scene::TerrainLight>& light,
              int largest_side);

/// The same in two parts: the sky's light, and the sun's light without shadows.
struct LightParts {
    Image sky;
    Image sun;
};
LightParts light_parts(const scene::TerrainSurface& surface, const scene::TerrainLight& light,
                       int largest_side);

/// Light to compute before the terrain is drawn.
struct LightRequest {
    std::shared_ptr<const scene::TerrainSurface> surface; ///< the overview of a streamed terrain
    std::shared_ptr<scene::TileStream> stream;            ///< null: the terrain is in memory
    scene::TerrainLight light;
    bool in_parts = false; ///< light_parts() instead of lit_map()
    int largest_side = 0;  ///< of the maps, texels
};

struct PreparedLight {
    LightRequest request;
    Image lit; ///< or the sky's part; empty for a streamed terrain
    Image sun; ///< the sun's part, or empty
    std::shared_ptr<const scene::TerrainIrradiance> irradiance; ///< null unless streamed
};

/// On any thread.
PreparedLight prepare_light(LightRequest request);

/// The ground's maps for surface detail: albedo (sRGB); normals in local directions (xyz) and the
/// visible share of the sun's disc (w; 1 without a light). Both have lit_map's size.
struct GroundMap {
    Image albedo;
    Grid<glm::vec4> surface;
};
GroundMap ground_map(const scene::TerrainSurface& surface,
                     const std::optional<scene::TerrainLight>& light, int largest_side);

/// Of a tile of a stream, with the albedo's size and the overview's shadows. `irradiance`: null: no
/// shadows.
GroundMap ground_of_tile(const scene::TileBuilder& builder, const scene::TerrainTile& tile,
                         const scene::TerrainIrradiance* irradiance);

/// Texture coordinate = sample · xy + zw; the outermost texel centres are the outermost samples.
glm::vec4 texture_from_sample(glm::ivec2 samples, glm::ivec2 texels);

} // namespace reljef::view
