#pragma once

#include <vector>

#include "engine/core/geometry.h"
#include "engine/terrain/field/heightfield.h"
#include "engine/terrain/field/placement.h"

namespace reljef::terrain {

/// A rectangle of cells: samples col … col+cols and row … row+rows, ends included. Neighbours share
/// their border samples.
struct Tile {
    int col = 0;
    int row = 0;
    int cols = 0; ///< cells
    int rows = 0; ///< cells
    Box bounds;   ///< of the placed surface, scene metres
};

/// Cells along a tile's side. 16-bit indices reach its 129² vertices.
inline constexpr int tile_cells = 128;

/// Cuts a heightfield into tiles of at most `tile_cells` cells a side, row after row.
std::vector<Tile> tile_layout(const Heightfield& heightfield, const Placement& placement);

/// The same tiles with the bounds of a flat surface at `height` metres.
std::vector<Tile> flat_tile_layout(const Heightfield& heightfield, const Placement& placement,
                                   double height);

/// Bounding box of the surface between samples `first` and `last`, scene metres. `range`: heights
/// of the surface, metres.
Box placed_bounds(const Placement& placement, glm::dvec2 first, glm::dvec2 last, HeightRange range);

/// The middle of the height range, where the flat reference surface lies.
inline double reference_height(const Heightfield& heightfield) {
    return 0.5 * (heightfield.range.low + heightfield.range.high);
}

} // namespace reljef::terrain
