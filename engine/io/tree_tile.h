#pragma once

#include <optional>
#include <stop_token>
#include <string>

#include "engine/io/tile_set.h"
#include "engine/terrain/tile_tree.h"

namespace reljef::io {

/// The heights of a tile of a tree over `grid`, of a set: its vertices and one step around them,
/// beyond the grid's border those of the border. Above level 0 they are averages over a step. NaN
/// at voids and holes; files that failed are faults.
TileWindow read_tree_tile(const TileSet& tiles, const TileGrid& grid, const terrain::TileTree& tree,
                          terrain::TreeTile tile, Gaps gaps, std::stop_token stop = {});

/// The places of `size` texels edge to edge over the `cells` of a tile of a tree over `grid`.
TileGrid picture_grid(const TileGrid& grid, terrain::TreeTile tile, glm::ivec2 cells,
                      glm::ivec2 size);

/// Where a file of the set is so large that coarse views of it take long, because it has no
/// overviews: a sentence that names the first such file and the command that makes them.
std::optional<std::string> missing_overviews(const TileSet& tiles);

} // namespace reljef::io
