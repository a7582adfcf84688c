#pragma once

#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/grid.h"

namespace reljef::terrain {

/// Share of the sun's disc that each sample sees over the terrain around it, 0 (shadow) to 255
/// (all), found in one sweep along the light: the shadow's height over the ground is carried from
/// sample to sample and falls with the sun's altitude. The penumbra is that of a disc 0.53° wide
/// (the sun's), at least half a sample. `to_sun` points towards the sun (x east, y north, z up);
/// `spacing` in metres over the exaggeration. A sun on or below the horizon leaves nothing lit.
/// `around`: the last column lies where the first does, and shadows fall across.
Grid<std::uint8_t> sun_visibility(GridView<const float> heights, glm::dvec2 spacing,
                                  double exaggeration, glm::dvec3 to_sun, bool around = false);

} // namespace reljef::terrain
