#pragma once

#include <cstddef>
#include <vector>

#include "engine/cast/block_rays.h"
#include "engine/cast/lit_levels.h"
#include "engine/cast/packet/block_kernel.h"
#include "engine/view/draw_list.h"

namespace reljef::cast {

/// What ground needs to reflect point lights: its albedo and its normals.
struct LitGround {
    LitLevels albedo;
    LitLevels normals;

    [[nodiscard]] std::size_t bytes() const { return albedo.bytes() + normals.bytes(); }
    /// Sets PlacedTile::albedo and normals. `first_sample`: as LitLevels::paint().
    void paint(PlacedTile& tile, glm::vec2 first_sample = glm::vec2(0.0F)) const;
};

/// Of a terrain in memory. `max_side`: of its maps, texels.
LitGround lit_ground(const scene::TerrainSurface& surface, int max_side);
/// Of a tile of a stream.
LitGround lit_ground(const scene::TerrainTile& tile);

/// The point lights of a list; empty without some.
std::vector<PointLightPaint> point_light_paints(const view::DrawList& list);

} // namespace reljef::cast
