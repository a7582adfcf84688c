#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/cast/block_rays.h"
#include "engine/cast/frame/mesh_frame.h"
#include "engine/cast/frame/seen_terrain.h"
#include "engine/cast/frame/sun_tiles.h"
#include "engine/scene/streaming/certain_sun.h"
#include "engine/view/draw_list.h"

namespace reljef::cast {

/// Whether rays look for the sun from the terrain's hits.
bool casts_shadows(const SeenTerrain& seen);

/// The loaded tiles above the tiles of a list whose terrains cast shadows.
std::vector<std::shared_ptr<const scene::TerrainTile>> tiles_above(const view::DrawList& list);

/// Whether no course describes the rays from a terrain on the ellipsoid to the sun of a list, see
/// SunCourse::create().
bool bends_too_much(const view::DrawList& list, const SeenTerrain& seen);

/// Adds the tiles that may hide the sun of a list from each other, and those of `beside`.
/// Precondition: !bends_too_much() on the ellipsoid.
void add_sun(const view::DrawList& list, const SeenTerrain& seen, std::vector<SunSource> beside,
             PlacedTiles& placed);

/// The same tiles, as those that may hide the sun from meshes; empty if the terrain casts no
/// shadows, and without a sun. `seen` and the tiles outlive it.
std::optional<ShadowGround> shadow_ground(const view::DrawList& list, const SeenTerrain& seen,
                                          const PlacedTiles& placed, std::vector<SunSource> beside);

/// The rays for which scene::certain_sun() holds, of a terrain in memory; empty if nothing is
/// certain of them. Precondition: add_sun().
std::optional<scene::SunRays> certain_sun_rays(const view::DrawList& list, const SeenTerrain& seen,
                                               const PlacedTile& tile);

/// As BlockJob::certain_sun, of a terrain.
std::vector<std::int32_t> packed_certain_sun(const scene::TerrainSurface& surface,
                                             const scene::SunRays& rays);
/// BlockJob::certain_stride for the cells of a row.
int certain_stride(int cells);

} // namespace reljef::cast
