#pragma once

#include <memory>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/cast/block_rays.h"
#include "engine/cast/ray_tile.h"
#include "engine/cast/sun_course.h"
#include "engine/core/geometry.h"

namespace reljef::cast {

/// A tile that may hide the sun; samples of the terrain = first + step · sample of the tile. Where
/// rays bend, these are samples of the terrain's surface.
struct SunSource {
    const RayTile* tile = nullptr;
    glm::dvec2 first{0.0};
    glm::dvec2 step{1.0};
};

/// Rays to the sun, in samples of the terrain and metres of height.
struct TowardSun {
    glm::dvec3 straight{0.0}; ///< it rises
    /// On the ellipsoid, instead of these.
    std::shared_ptr<const SunCourse> bent = nullptr;
};

/// Sets PlacedTile::sun_tiles: of all placed tiles, and of `beside`, those between a tile and the
/// sun.
void add_sun_tiles(PlacedTiles& placed, std::span<const SunSource> beside, const TowardSun& sun);

/// The placed tiles as sources.
std::vector<SunSource> sun_sources(const PlacedTiles& placed);

/// The tiles between places and the sun, the nearest first. `box`: of the places; their samples are
/// relative to `base`.
std::vector<SunTile> sun_tiles_from(const Box& box, glm::ivec2 base,
                                    std::span<const SunSource> sources, const TowardSun& sun);

} // namespace reljef::cast
