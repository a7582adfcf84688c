#pragma once

#include <cstdint>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include "engine/core/color.h"
#include "engine/core/grid.h"
#include "terrains/generators.h"
#include "terrains/natural/erosion.h"

/// The steps of generate_natural(). All grids of a land have the same size. Cells lie
/// `design_spacing` metres apart; generate_natural() scales the result.
namespace reljef::terrains::natural {

inline constexpr float design_spacing = 20.0F; // metres
inline constexpr float base_height = 300.0F;   // metres of the lowest outlet

/// `size` >= 16; `spacing` and `tileable` have no effect. When stopped, results are unusable.
using LandOptions = GeneratorOptions;

struct Land {
    Grid<float> heights;
    Drainage drainage;
    Grid<float> above_water; ///< metres above the stream that a cell drains to
    Grid<float> water;       ///< share of the cell under water, [0,1]
    Grid<float> gravel;      ///< share of the cell under gravel, [0,1]
    Grid<std::uint8_t> lake; ///< 1 in a lake
};

/// Eroded mountains and their drainage, from the coarsest grid to the finest.
Land make_relief(const LandOptions& options);

/// Widens the valley floors, adds lakes and fills `above_water` and `lake`.
void shape_valleys(Land& land, const LandOptions& options);

/// Draws the streams as smooth lines into `water` and `gravel`, and cuts their beds.
void draw_streams(Land& land, const LandOptions& options);

/// The albedo seen from above.
Image paint_cover(const Land& land, const LandOptions& options);

using glm::smoothstep;

inline glm::ivec2 place_of(std::int32_t cell, int cols) {
    return {cell % cols, cell / cols};
}

inline float catchment(const Drainage& drainage, std::size_t cell) { // km²
    return drainage.area[cell] * (design_spacing * design_spacing * 1.0e-6F);
}

/// Averages over squares of 2 radius + 1 cells, `passes` times. The border cells repeat outwards.
void blur(Grid<float>& values, int radius, int passes, unsigned threads);

} // namespace reljef::terrains::natural
