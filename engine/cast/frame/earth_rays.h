#pragma once

#include <memory>
#include <vector>

#include "engine/cast/block_rays.h"
#include "engine/cast/curved_rays.h"
#include "engine/cast/frame/seen_terrain.h"

namespace reljef::cast {

/// The rays of a picture over a terrain on the ellipsoid.
std::shared_ptr<const CurvedRays> earth_rays(const view::DrawList& list, const SeenTerrain& seen,
                                             const CurvedRays::Options& options);

/// Rows of a terrain in memory whose cells have one size: on the ellipsoid, those at a pole are
/// shorter.
struct RowPart {
    int first = 0; ///< row
    int cells = 1;
    double even_first = 0.0; ///< EarthMap
    double even_step = 1.0;
    unsigned walls = 0; ///< BlockJob::walls
};

/// From north to south.
std::vector<RowPart> row_parts(const scene::TerrainNode& node);

/// The place of a part's tile among the samples of the terrain.
void place_part(const RowPart& part, PlacedTile& tile);

/// Sets where the tiles of a globe begin anew. Those of a terrain in memory need walls there.
void join_ends(const SeenTerrain& seen, PlacedTiles& placed);

} // namespace reljef::cast
