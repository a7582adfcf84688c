#pragma once

#include <span>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/cast/block_rays.h"
#include "engine/cast/ray_tile.h"

namespace reljef::cast {

/// A tile that may hide the sun; samples of the terrain = first + step · sample of the tile.
struct SunSource {
    const RayTile* tile = nullptr;
    glm::dvec2 first{0.0};
    glm::dvec2 step{1.0};
};

/// Sets PlacedTile::sun_tiles: of all placed tiles, and of `beside`, those between a tile and the
/// sun. `to_sun`: samples of the terrain and metres of height; it rises.
void add_sun_tiles(PlacedTiles& placed, std::span<const SunSource> beside, glm::dvec3 to_sun);

} // namespace reljef::cast
