#pragma once

#include <optional>
#include <stop_token>
#include <string>

#include "engine/io/tile_set.h"
#include "engine/terrain/tree/tile_tree.h"

namespace reljef::io {

/// The heights of a tile of a tree over `grid`, of a set: its vertices and one step around them,
/// beyond the grid's border those of the border. Above level 0 they are averages over a step. NaN
/// at voids and holes; files that failed are faults.
TileWindow read_tree_tile(const TileSet& tiles, const TileGrid& grid, const terrain::TileTree& tree,
                          terrain::TreeTile tile, Gaps gaps, std::stop_token stop = {});

/// A grid and what closes it where it goes all around the Earth.
struct ClosedGrid {
    TileGrid grid; ///< with the samples of the closing: at a pole they lie on beyond it
    geo::GlobalWrap closing;
    int refinement = 1;        ///< samples of the grid in one of the source's
    double north_height = 0.0; ///< of the poles, metres
    double south_height = 0.0;
};

/// `refinement` samples for one of `grid`, which has no closing yet.
ClosedGrid closed_grid(const TileGrid& grid, const geo::GlobalWrap& closing, int refinement);

/// The same where the last column is the first again, and poles have one height.
TileWindow read_tree_tile(const TileSet& tiles, const ClosedGrid& ground,
                          const terrain::TileTree& tree, terrain::TreeTile tile, Gaps gaps,
                          std::stop_token stop = {});

/// The places of `size` texels edge to edge over the `cells` of a tile of a tree over `grid`.
TileGrid picture_grid(const TileGrid& grid, terrain::TreeTile tile, glm::ivec2 cells,
                      glm::ivec2 size);

/// Where a file of the set is so large that coarse views of it take long, because it has no
/// overviews: a sentence that names the first such file and the command that makes them.
std::optional<std::string> missing_overviews(const TileSet& tiles);

} // namespace reljef::io
