#pragma once

#include <optional>
#include <stop_token>
#include <string>

#include "engine/io/tile_set.h"
#include "engine/terrain/tree/tile_tree.h"

namespace reljef::io {

/// A grid with the samples that close it around the Earth.
struct WrappedGrid {
    TileGrid grid; ///< pole rows lie one step outside
    geo::GlobalWrap wrap{};
    int refinement = 1;        ///< samples per sample of the source
    double north_height = 0.0; ///< poles, metres
    double south_height = 0.0;
};

/// Refines a grid and adds the samples of its wrap.
WrappedGrid wrapped_grid(const TileGrid& grid, const geo::GlobalWrap& wrap, int refinement);

/// Heights of the added poles of a grid, metres: means of the rows beside them; NaN without any.
struct PoleHeights {
    double north = 0.0;
    double south = 0.0;
};
/// Fails if a file cannot be read.
Result<PoleHeights> pole_heights(const TileSet& tiles, const geo::GlobalWrap& wrap);

/// Heights at the vertices of a tree's tile and one step around them; repeats the border outside
/// the grid. Averages over a step above level 0. NaN at voids and holes.
TileWindow read_tree_tile(const TileSet& tiles, const WrappedGrid& ground,
                          const terrain::TileTree& tree, terrain::TreeTile tile, Gaps gaps,
                          std::stop_token stop = {});

/// Positions of `size` texels, edge to edge over the `cells` of a tree's tile.
TileGrid picture_grid(const TileGrid& grid, terrain::TreeTile tile, glm::ivec2 cells,
                      glm::ivec2 size);

/// A warning for the first large file without usable overviews, with the command that adds them.
std::optional<std::string> missing_overviews(const TileSet& tiles);

} // namespace reljef::io
