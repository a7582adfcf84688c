#pragma once

#include <cstdint>

#include "engine/core/grid.h"
#include "engine/core/parallel_for.h"

namespace reljef::material {

/// Lower steps are no walls of buildings, metres.
inline constexpr double wall_height = 2.5;

struct StraightWalls {
    Grid<float> heights;
    std::size_t changed = 0; ///< samples
    double largest = 0.0;    ///< change, metres
};

/// Heights whose walls look straight. In surface models a sample lies on a roof or on the ground,
/// so walls follow rows and columns. Here samples at walls get heights between the two, by their
/// distance to the wall: an estimate from the share of roof among the samples around, weighted by a
/// normal distribution. All other samples keep their heights: those without a rise of `min_rise`
/// metres around them, voids and what is near them, posts of a sample, and walls that were averaged
/// before, with samples halfway between roof and ground. If the result is filtered again, some
/// samples at corners change once more. Empty if it was stopped. Preconditions: `void_mask` is
/// empty or as large as the heights; min_rise > 0.
StraightWalls straight_walls(GridView<const float> heights, const Grid<std::uint8_t>& void_mask,
                             double min_rise, const ParallelOptions& parallel = {});

} // namespace reljef::material
