#pragma once

#include <limits>

#include "engine/core/grid.h"

namespace reljef {

/// What one pixel shows: a place on the heightfield (samples), its height (true metres) and its
/// depth along the view axis (scene metres). On a mesh with a tile of detail: the place in the tile
/// (texels) and its height there in [0,1]; on any other mesh −1, −1, 0. Sky: −1, −1, 0, infinity.
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
