#pragma once

#include <cstdint>
#include <optional>

#include <glm/vec3.hpp>

#include "engine/core/grid.h"
#include "engine/scene/streaming/terrain_light.h"
#include "engine/terrain/field/min_max_pyramid.h"
#include "engine/terrain/field/placement.h"

namespace reljef::scene {

/// What is certain about rays to the sun from all places of a cell.
enum class CertainSun : std::uint8_t {
    unknown,
    lit, ///< nothing hides the sun
    dark ///< the terrain hides it
};

/// How rays to the sun are cast.
struct SunRays {
    glm::dvec3 to_sun{0.0, 0.0, 1.0}; ///< samples (col, row) and metres; it rises
    double max_lift = 0.0;            ///< metres above the surface at which rays begin at most
    /// Metres. Where the heights within a cell differ by more, rounded rays may begin below the
    /// surface: nothing is certain of it and its neighbours.
    double max_variation = 0.0;
};

/// Of each cell of a heightfield on a plane. Strips along the sun's direction are swept from the
/// sun's side: the highest and the lowest heights that rays of a strip pass, less what the rays
/// rise on the way, bound what may hide the sun. Rays may be rounded by 2^-10 of a cell.
/// Precondition: heights are finite.
Grid<CertainSun> certain_sun(GridView<const float> heights, const SunRays& rays);

/// The direction to the sun in samples of a placement (col, row, metres); empty if it is not on a
/// plane, or if the sun does not rise.
std::optional<glm::dvec3> sun_in_samples(const terrain::Placement& placement,
                                         const TerrainLight& light);

} // namespace reljef::scene
