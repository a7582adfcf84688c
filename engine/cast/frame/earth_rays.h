#pragma once

#include <memory>

#include "engine/cast/block_rays.h"
#include "engine/cast/curved_rays.h"
#include "engine/cast/frame/seen_terrain.h"

namespace reljef::cast {

/// The rays of a picture over a terrain on the ellipsoid. `threads`: 0: one per hardware thread.
std::shared_ptr<const CurvedRays> earth_rays(const view::DrawList& list, const SeenTerrain& seen,
                                             unsigned threads);

/// Sets where the tiles of a globe begin anew. Those of a terrain in memory need walls there.
void join_ends(const SeenTerrain& seen, PlacedTiles& placed);

} // namespace reljef::cast
