#pragma once

#include <limits>

#include <glm/vec2.hpp>

#include "engine/core/geometry.h"
#include "engine/core/grid.h"

namespace reljef {

/// Surface point of a pixel. Column and row are sums of two floats: at column 10 000 a float has
/// steps of a thousandth of a sample, which are pixels wide near the eye.
/// - Terrain: (col, row) in samples of its heightfield, height in true metres, depth along the view
///   axis in scene metres.
/// - Mesh with surface detail: (col, row) in texels, height in [0,1]. Other mesh: −1, −1, 0.
/// - Sky: −1, −1, 0, infinity.
struct Hit {
    float col = -1.0F;
    float row = -1.0F;
    float height = 0.0F;
    float depth = std::numeric_limits<float>::infinity();
    float col_low = 0.0F; ///< to be added to col
    float row_low = 0.0F; ///< to be added to row

    /// Column and row.
    [[nodiscard]] glm::dvec2 place() const {
        return glm::dvec2(col, row) + glm::dvec2(col_low, row_low);
    }
    [[nodiscard]] bool is_sky() const { return depth == std::numeric_limits<float>::infinity(); }
};
static_assert(sizeof(Hit) == 24);

/// Rounds a place on the terrain. `height`: true metres; `depth`: scene metres.
inline Hit hit_at(glm::dvec2 place, double height, double depth) {
    const glm::dvec2 high(rounded_to_float(place.x), rounded_to_float(place.y));
    const glm::vec2 low(place - high);
    return {static_cast<float>(high.x),
            static_cast<float>(high.y),
            static_cast<float>(height),
            static_cast<float>(depth),
            low.x,
            low.y};
}

/// One hit per pixel, row 0 at the top.
using HitBuffer = Grid<Hit>;

} // namespace reljef
