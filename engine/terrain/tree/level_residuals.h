#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/terrain/tree/tile_error.h"

// How far the samples of a chunk are from the surface of a coarser level. Private to
// tile_error.cpp.

namespace reljef::terrain {

inline constexpr float infinite = std::numeric_limits<float>::infinity();

// NaN never wins if the first argument is none.
inline float lower(float a, float b) {
    return b < a ? b : a;
}
inline float higher(float a, float b) {
    return b > a ? b : a;
}

/// Along an axis: the base vertices of a chunk on the raster, among those of a coarser level.
struct CoarserAxis {
    int step = 1;              ///< base cells per coarser cell
    int cells = 0;             ///< coarser cells on the raster
    std::vector<float> shares; ///< of each base vertex: of its coarser cell, up to it

    [[nodiscard]] int vertices() const { return static_cast<int>(shares.size()); }
    /// The first base vertex of a coarser cell, and the last one, which the raster's end may cut.
    [[nodiscard]] int first(int cell) const { return cell * step; }
    [[nodiscard]] int last(int cell) const { return std::min(first(cell + 1), vertices() - 1); }
};

/// Columns (0) or rows (1) of a chunk, and of the level `levels` above its base. Cells at a pole,
/// and those that the raster's end cuts, are shorter than others.
CoarserAxis coarser_axis(const TileTree& tree, Chunk chunk, int levels, int axis);

/// Vertices with a border around the chunk's own.
struct BorderedHeights {
    const Grid<float>& heights;
    int border = 0;                       ///< vertices
    const Residuals* residuals = nullptr; ///< of its cells; null: the vertices are the samples
};

/// In metres: for each coarser cell the range of its samples minus its bilinear surface. The range
/// of the difference of the two surfaces moves that of the base's cells. Cells outside the raster
/// have none.
Residuals residuals_over(const BorderedHeights& base, const BorderedHeights& coarser,
                         const std::array<CoarserAxis, 2>& axes, glm::ivec2 cells);

} // namespace reljef::terrain
