#pragma once

#include <cstdint>

#include <glm/vec2.hpp>

namespace reljef::terrains {

/// The cell of a periodic Voronoi diagram that a point lies in.
struct VoronoiCell {
    glm::ivec2 id{0};          ///< of the cell, in [0, period)
    glm::vec2 from_seed{0.0F}; ///< of the point
    float to_edge = 0.0F;      ///< distance to the nearest border
};

/// One seed in each unit square, up to `jitter` / 2 off its middle; the diagram repeats every
/// `period` squares. (Worley 1996; the distance to the border is exact.)
VoronoiCell voronoi(std::uint32_t seed, glm::vec2 point, int period, float jitter);

} // namespace reljef::terrains
