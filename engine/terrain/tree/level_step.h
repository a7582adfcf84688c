#pragma once

#include <array>
#include <limits>

#include "engine/terrain/tree/tile_error.h"

// One level of a chunk from the next finer one. Private to tile_error.cpp.

namespace reljef::terrain {

inline constexpr float infinite = std::numeric_limits<float>::infinity();

// NaN never wins if the first argument is none.
inline float lower(float a, float b) {
    return b < a ? b : a;
}
inline float higher(float a, float b) {
    return b > a ? b : a;
}

/// Between two heights; one that has no share may be a void.
float mixed(float a, float b, double share);

/// Along an axis: where the finer vertex between the last two coarser ones lies, because the
/// raster's end cuts their cell.
struct LastCell {
    int cell = -1;      ///< its index; -1: none is cut
    double share = 0.5; ///< of the cell
};

/// The finer level of a step upwards.
struct FinerLevel {
    VertexRows rows;
    glm::ivec2 vertices{0}; ///< odd
    const Residuals* residuals = nullptr;
};

/// `cells`: of the chunk at the coarser level; `inside`: those on the raster; `cuts`: of columns
/// and rows.
ChunkLevel coarser_level(const FinerLevel& finer, glm::ivec2 cells, glm::ivec2 inside,
                         const std::array<LastCell, 2>& cuts);

/// The vertices of the coarser level that have all finer ones around them. Precondition: an odd
/// number of vertices a side.
Grid<float> coarser_heights(const Grid<float>& finer);

/// Copies the outermost vertices of a level (0 and `last`) to those outside; `first`: of the grid.
void repeat_border(Grid<float>& heights, glm::ivec2 first, glm::ivec2 last);

} // namespace reljef::terrain
