#pragma once

#include <cstdint>

#include <glm/vec2.hpp>

#include "engine/core/grid.h"

namespace reljef::terrain {

/// Share of the light of an evenly bright sky that reaches each sample, 0 to 255: the mean over all
/// azimuths of 1 / (1 + s²), where s >= 0 is the steepest slope to the ground that way (Dozier and
/// Frew 1990 for level ground). On an inclined plane it is (1 + cos slope) / 2, as without
/// occlusion. The horizons of 16 azimuths are exact along lines of samples: a sweep keeps the
/// convex hull of the ground behind it (Timonen and Westerholm 2010). `spacing`: metres.
Grid<std::uint8_t> sky_share(GridView<const float> heights, glm::dvec2 spacing,
                             double exaggeration);

} // namespace reljef::terrain
