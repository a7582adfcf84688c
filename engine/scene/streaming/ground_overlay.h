#pragma once

#include <glm/vec2.hpp>

#include "engine/core/color.h"
#include "engine/scene/streaming/terrain_surface.h"
#include "engine/scene/streaming/terrain_tile.h"
#include "engine/scene/streaming/tile_builder.h"

namespace reljef::scene {

/// Blends TerrainSurface::overlay() over the colours of a surface, whose outermost texels are the
/// outermost samples.
void blend_overlay(const TerrainSurface& surface, Image& colors);

/// Blends the overlay of the builder's overview over TerrainTile::albedo. `vertex`: the first of
/// the tile that `tile` has.
void blend_overlay(const TileBuilder& builder, TerrainTile& tile, glm::ivec2 vertex = {0, 0});

} // namespace reljef::scene
