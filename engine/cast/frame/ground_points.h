#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/cast/block_rays.h"
#include "engine/cast/lit_levels.h"
#include "engine/cast/packet/block_kernel.h"
#include "engine/scene/streaming/terrain_light.h"
#include "engine/scene/streaming/tile_stream.h"
#include "engine/view/draw_list.h"

namespace reljef::cast {

/// What ground needs to reflect point lights, or to show a detail texture: its albedo and its
/// normals, and how much of the sun it sees.
struct LitGround {
    LitLevels albedo;
    LitLevels normals;
    std::optional<LitLevels> sun_share; ///< absent: not needed

    [[nodiscard]] std::size_t bytes() const {
        return albedo.bytes() + normals.bytes() + (sun_share ? sun_share->bytes() : 0);
    }
    /// Sets PlacedTile::albedo, normals and sun_share. `first_sample`: as LitLevels::paint().
    void paint(PlacedTile& tile, glm::vec2 first_sample = glm::vec2(0.0F)) const;
};

/// Of a terrain in memory. `light`: absent: without `sun_share`. `max_side`: of its maps, texels.
LitGround lit_ground(const scene::TerrainSurface& surface,
                     const std::optional<scene::TerrainLight>& light, int max_side);
/// Of a tile of a stream. `irradiance`: null: without `sun_share`.
LitGround lit_ground(const scene::TileBuilder& builder, const scene::TerrainTile& tile,
                     const scene::TerrainIrradiance* irradiance);

/// The point lights of a list; empty without some.
std::vector<PointLightPaint> point_light_paints(const view::DrawList& list);

} // namespace reljef::cast
