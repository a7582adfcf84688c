#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/cast/block_rays.h"
#include "engine/cast/ray_tile.h"
#include "engine/core/geometry.h"

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

/// The same for places in `box` (samples of the terrain and metres of height), whose samples are
/// relative to `base`: indices of `sources`, the nearest first.
std::vector<std::size_t> sun_sources(const Box& box, std::span<const SunSource> sources,
                                     glm::dvec3 to_sun);
SunTile sun_tile_from(glm::ivec2 base, const SunSource& source, glm::dvec3 to_sun);

} // namespace reljef::cast
