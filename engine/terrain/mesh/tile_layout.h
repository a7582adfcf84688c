#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/geometry.h"
#include "engine/terrain/field/heightfield.h"
#include "engine/terrain/field/placement.h"

namespace reljef::terrain {

/// The cells of a tile among those of a heightfield. Neighbours share their border samples.
struct TileCells {
    glm::ivec2 first{0}; ///< sample, or cell
    glm::ivec2 count{0};

    [[nodiscard]] glm::ivec2 last() const { return first + count; } ///< sample
};

/// Cells along a tile's side. 16-bit indices reach its 129² vertices.
inline constexpr int tile_cells = 128;

/// Cuts `cells` into tiles of at most `tile_cells` cells a side, row after row.
std::vector<TileCells> tile_layout(glm::ivec2 cells);

/// Bounding box of the surface between samples `first` and `last`, scene metres. `range`: heights
/// of the surface, metres.
Box placed_bounds(const Placement& placement, glm::dvec2 first, glm::dvec2 last, HeightRange range);

/// The middle of the height range, where the flat reference surface lies.
inline double reference_height(const Heightfield& heightfield) {
    return 0.5 * (heightfield.range.low + heightfield.range.high);
}

} // namespace reljef::terrain
