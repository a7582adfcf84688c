#pragma once

#include <algorithm>
#include <cstdint>
#include <stop_token>
#include <vector>

#include <glm/ext/vector_int2.hpp>

#include "engine/core/color.h"
#include "engine/core/grid.h"
#include "engine/core/parallel_for.h"
#include "terrains/natural/erosion.h"

/// The steps of generate_natural. All grids of a land have the same size; lengths are in metres of
/// the design, whose samples lie `design_spacing` apart.
namespace reljef::terrains::natural {

inline constexpr float design_spacing = 20.0F;

struct LandOptions {
    int size = 0; ///< cells a side, >= 16
    std::uint32_t seed = 1;
    unsigned threads = 0;
    Progress progress = {};
    std::stop_token stop = {}; ///< stopped, what comes out is of no use
};

struct Land {
    Grid<float> heights;
    Drainage drainage;
    Grid<float> above_water; ///< height over the stream that a cell drains to
    Grid<float> water;       ///< part of the cell under running or standing water, [0,1]
    Grid<float> gravel;      ///< part of the cell that is a bank of gravel, [0,1]
    Grid<std::uint8_t> lake; ///< 1 where a lake stands
};

/// Mountains worn by rivers from the coarsest grid to the finest, and their drainage.
Land make_relief(const LandOptions& options);

/// Widens the floors of the valleys, sets lakes into them and fills `above_water` and `lake`.
void shape_valleys(Land& land, const LandOptions& options);

/// Draws the streams as smooth lines into `water` and `gravel`, and cuts their beds.
void draw_streams(Land& land, const LandOptions& options);

/// The colour of the ground seen from above, without sun or shadow.
Image paint_cover(const Land& land, const LandOptions& options);

/// 0 below `low`, 1 above `high`, smooth between.
inline float smoothstep(float low, float high, float value) {
    const float t = std::clamp((value - low) / (high - low), 0.0F, 1.0F);
    return t * t * (3.0F - 2.0F * t);
}

/// The column and row of a cell.
inline glm::ivec2 place_of(std::int32_t cell, int cols) {
    return {cell % cols, cell / cols};
}

/// Square kilometres that drain through a cell.
inline float catchment(const Drainage& drainage, std::size_t cell) {
    return drainage.area[cell] * (design_spacing * design_spacing * 1.0e-6F);
}

/// Averages over squares of 2 radius + 1 cells, `passes` times; the border is repeated outwards.
void blur(Grid<float>& values, int radius, int passes, unsigned threads);

} // namespace reljef::terrains::natural
