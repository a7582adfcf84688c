#pragma once

#include <optional>
#include <span>

#include "engine/core/geometry.h"
#include "engine/scene/graph/scene.h"
#include "engine/view/rays/ray_course.h"
#include "engine/view/tile_selection.h"

namespace reljef::view {

/// Of the box that rays of a relief begin and end in, above and below its heights, as a share of
/// their range: they begin above and end below the surface despite rounding. Floats near 1 have
/// errors of 2^-24, and a ray adds a few of them.
inline constexpr double relief_margin = 1.0 / 4096.0;

/// Side of the block of pixels whose rays begin where their beam meets the first ground.
inline constexpr int pixels_a_beam = 8;

// The samples that the rays of a relief may meet: columns and rows of the terrain's surface (of a
// stream: its overview), heights in true metres.

/// Over the drawn tiles of a stream, with all heights of the overview; empty without tiles.
Box samples_of(const scene::TerrainNode& terrain, std::span<const TileSelection::Drawn> drawn);

/// Of a surface in memory: those of the tiles that may be visible. `frustum`: local metres.
Box seen_samples(const scene::TerrainSurface& surface, const Frustum& frustum);

/// All, for rays to the sun; empty if the terrain's technique casts none.
std::optional<SunRays> sun_rays(const scene::TerrainNode& terrain,
                                const std::optional<scene::Light>& sun);

} // namespace reljef::view
