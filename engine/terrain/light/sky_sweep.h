#pragma once

#include <glm/vec2.hpp>

#include "engine/core/grid.h"

namespace reljef::terrain {

/// Lines of samples in one direction, which are swept both ways.
struct SkySweep {
    GridView<const float> heights;
    glm::ivec2 step{0, 1}; ///< from sample to sample; y >= 1
    float rise = 1.0F;     ///< metres of height, exaggerated, over the metres of a step
    float weight = 0.0F;   ///< of the light from each of the two directions
};

/// The largest number of lines that are swept side by side.
inline constexpr int max_sky_lines = 64;

/// A part of the lines: those whose first row is below step.y, with the columns there (or where
/// they would be: outside of the grid on the left or right) in a range.
struct SkyLines {
    int row = 0;
    int first_col = 0;
    int end_col = 0; ///< if other lines follow, a multiple of max_sky_lines after the first
};

/// Adds `weight` / (1 + s²) to the samples on lines, where s >= 0 is the steepest slope to the
/// ground behind them. Parts without a common line may be swept at the same time.
void sweep_sky(const SkySweep& sweep, const SkyLines& lines, Grid<float>& share);

} // namespace reljef::terrain
