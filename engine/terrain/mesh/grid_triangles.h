#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "engine/core/check.h"

namespace reljef::terrain {

/// Two triangles for each of cols × rows quads over (cols + 1) × (rows + 1) vertices, which are
/// numbered row after row. With columns to the right and rows downwards, triangles are
/// counter-clockwise, and the diagonal runs from the first to the last corner.
/// Precondition: `Index` reaches all vertices.
template <class Index> std::vector<Index> grid_triangles(int cols, int rows) {
    check(static_cast<std::size_t>(cols + 1) * static_cast<std::size_t>(rows + 1) - 1 <=
              std::numeric_limits<Index>::max(),
          "more vertices than the indices reach");
    const auto vertex = [&](int col, int row) {
        return static_cast<Index>(row * (cols + 1) + col);
    };
    std::vector<Index> indices;
    indices.reserve(6U * static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows));
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
            for (const Index index :
                 {vertex(col, row), vertex(col, row + 1), vertex(col + 1, row + 1),
                  vertex(col, row), vertex(col + 1, row + 1), vertex(col + 1, row)}) {
                indices.push_back(index);
            }
        }
    }
    return indices;
}

} // namespace reljef::terrain
