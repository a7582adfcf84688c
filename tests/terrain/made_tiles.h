#pragma once

#include <glm/vec2.hpp>

#include "tests/terrain/made_heightfield.h"

namespace reljef::test {

/// Of an overview with a sample in the middle of each `reduction` of a side's samples; `height` of
/// a place in these, glm::dvec2.
template <class Height>
Grid<float> overview_heights(int side, int reduction, const Height& height) {
    return made_heights(side / reduction, side / reduction, [&](int col, int row) {
        return height((glm::dvec2(col, row) + 0.5) * static_cast<double>(reduction) - 0.5);
    });
}

/// Of a tile of a tree, as scene::TileContent has them: with one around its vertices; `height` of a
/// vertex, glm::ivec2.
template <class Height> Grid<float> tile_heights(glm::ivec2 cells, const Height& height) {
    return made_heights(cells.x + 3, cells.y + 3,
                        [&](int col, int row) { return height(glm::ivec2(col - 1, row - 1)); });
}

} // namespace reljef::test
