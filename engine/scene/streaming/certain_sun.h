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

/// Of each cell of a heightfield on a plane, for rays that begin at most `lift` metres above the
/// surface. `to_sun`: samples (col, row) and metres; it rises. Strips along the sun's direction are
/// swept from the sun's side: the highest and the lowest heights that rays of a strip pass, less
/// what the rays rise on the way, bound what may hide the sun. Precondition: heights are finite.
Grid<CertainSun> certain_sun(GridView<const float> heights, glm::dvec3 to_sun, double lift);

/// The direction to the sun in samples of a placement (col, row, metres); empty if it is not on a
/// plane, or if the sun does not rise.
std::optional<glm::dvec3> sun_in_samples(const terrain::Placement& placement,
                                         const TerrainLight& light);

/// A `lift` for all kinds of rays over a terrain, metres: shaders begin 1/4096 of its heights above
/// it, rays on the CPU near what floats round.
double certain_sun_lift(terrain::MinMax heights);

} // namespace reljef::scene
