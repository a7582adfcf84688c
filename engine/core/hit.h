#pragma once

#include <limits>

#include "engine/core/grid.h"

namespace reljef {

/// Surface point of a pixel.
/// - Terrain: (col, row) in samples of its heightfield, height in true metres, depth along the view
/// axis in scene
///   metres.
/// - Mesh with surface detail: (col, row) in texels, height in [0,1]. Other mesh: −1, −1, 0.
/// - Sky: −1, −1, 0, infinity.
struct Hit {
    float col = -1.0F;
    float row = -1.0F;
    float height = 0.0F;
    float depth = std::numeric_limits<float>::infinity();

    [[nodiscard]] bool is_sky() const { return depth == std::numeric_limits<float>::infinity(); }
};
static_assert(sizeof(Hit) == 16);

/// One hit per pixel, row 0 at the top.
using HitBuffer = Grid<Hit>;

} // namespace reljef
