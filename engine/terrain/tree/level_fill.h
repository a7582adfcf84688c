#pragma once

#include <glm/vec2.hpp>

#include "engine/core/grid.h"
#include "engine/terrain/tree/tile_tree.h"

// What fills the voids of a tree's levels: the surface of the next coarser level, whose voids are
// filled in the same way. So a void is as smooth as the levels that know nothing finer, and joins
// the heights around it. A vertex is a void only if all finer vertices around it are. Therefore the
// difference of two levels is 0 at the voids of the finer one, and depends on no fill elsewhere.

namespace reljef::terrain {

/// Vertices of a level.
struct LevelVertices {
    int level = 0;
    glm::ivec2 first{0};      ///< of the grid
    Grid<float> heights = {}; ///< metres; NaN: void
};

[[nodiscard]] bool has_voids(const Grid<float>& heights);

/// Fills voids from the next coarser level, which is filled. Those over cells that `coarser` lacks
/// stay.
LevelVertices filled_from(const TileTree& tree, LevelVertices finer, const LevelVertices& coarser);

/// Fills the samples in a tile. `samples`: as for heights_from_samples. `heights`: at the tile's
/// vertices and one step around them, filled.
Grid<float> filled_samples(const TileTree& tree, TreeTile tile, Grid<float> samples,
                           Grid<float> heights);

} // namespace reljef::terrain
