#pragma once

#include <map>
#include <span>

#include "engine/scene/graph/terrain_tile.h"
#include "engine/terrain/tree/tile_tree.h"

namespace reljef::view {

/// How far the border of each tile may be above or below the borders of its neighbours, scene
/// metres, if each shows its vertices. An estimate beside unproven tiles. Only tiles with
/// neighbours are in it. Precondition: the tiles do not overlap. `exaggeration`: of their heights.
std::map<terrain::TreeTile, double> tile_gaps(const terrain::TileTree& tree,
                                              std::span<const scene::TileSummary* const> tiles,
                                              double exaggeration);

} // namespace reljef::view
