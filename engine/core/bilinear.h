#pragma once

#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include "engine/core/grid.h"

namespace reljef {

/// Bilinear interpolation at `place` (col, row). `value(sample)` converts a sample to a float or
/// vector. Precondition: `place` lies inside the grid.
template <class T, class Value>
auto bilinear(const Grid<T>& grid, glm::dvec2 place, const Value& value) {
    const glm::ivec2 last(grid.cols() - 1, grid.rows() - 1);
    const glm::ivec2 near = glm::min(glm::ivec2(place), last);
    const glm::vec2 part(place - glm::dvec2(near));
    if (part == glm::vec2(0.0F)) {
        return decltype(glm::mix(value(T{}), value(T{}), 0.0F))(value(grid(near.x, near.y)));
    }
    const glm::ivec2 far = glm::min(near + 1, last);
    const auto north = glm::mix(value(grid(near.x, near.y)), value(grid(far.x, near.y)), part.x);
    const auto south = glm::mix(value(grid(near.x, far.y)), value(grid(far.x, far.y)), part.x);
    return glm::mix(north, south, part.y);
}

} // namespace reljef
