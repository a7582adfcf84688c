#pragma once

#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/grid.h"

namespace reljef::terrain {

/// Visible share of the sun's disc at each sample, 0 (shadow) to 255 (all). A sweep along the light
/// carries the shadow's height from sample to sample. The penumbra is that of a disc 0.53° wide, at
/// least half a sample. `to_sun` points towards the sun (x east, y north, z up); `spacing` is in
/// metres. Nothing is lit by a sun at or below the horizon. `around`: the last column is the same
/// place as the first.
Grid<std::uint8_t> sun_visibility(GridView<const float> heights, glm::dvec2 spacing,
                                  double exaggeration, glm::dvec3 to_sun, bool around = false);

/// The heights over each sample, true metres, below which the ground around hides the middle of the
/// sun; -infinity: nowhere, infinity: everywhere. The other arguments as of sun_visibility(), with
/// an exaggeration above 0.
Grid<float> shadow_heights(GridView<const float> heights, glm::dvec2 spacing, double exaggeration,
                           glm::dvec3 to_sun);

} // namespace reljef::terrain
