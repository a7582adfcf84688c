#pragma once

#include <memory>
#include <span>
#include <vector>

#include "engine/cast/block_rays.h"
#include "engine/cast/curved_rays.h"
#include "engine/cast/frame/seen_terrain.h"
#include "engine/cast/frame/tile_pieces.h"

namespace reljef::cast {

/// The rays of a picture over a terrain on the ellipsoid.
std::shared_ptr<const CurvedRays> earth_rays(const view::DrawList& list, const SeenTerrain& seen,
                                             const CurvedRays::Options& options);

/// The pieces of a terrain in memory, from north to south: one, but for a globe's rows at the
/// poles.
std::vector<TilePiece> surface_pieces(const scene::TerrainNode& node);

/// Sets where the tiles of a globe begin anew. Those of a terrain in memory (`pieces`) need walls
/// there.
void join_ends(const SeenTerrain& seen, std::span<const TilePiece> pieces, PlacedTiles& placed);

} // namespace reljef::cast
