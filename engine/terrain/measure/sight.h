#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/grid.h"
#include "engine/core/parallel_for.h"
#include "engine/terrain/field/heightfield.h"
#include "engine/terrain/field/min_max_pyramid.h"
#include "engine/terrain/field/placement.h"
#include "engine/terrain/field/surface_caster.h"

namespace reljef::terrain {

/// How much ground may cover a target that counts as seen, metres: the hits of bent rays are within
/// half of it (see SurfaceRay).
inline constexpr double sight_tolerance = 0.002;

/// What hides a target: the first hit on the way from the eye. Empty if nothing does, or if a place
/// is not finite. Rays are straight, without refraction; over an ellipsoid the Earth is curved.
/// Both are world places on the ground or above it.
std::optional<SurfaceHit> obstacle_between(const SurfaceCaster& surface, glm::dvec3 eye,
                                           glm::dvec3 target);

struct ViewshedOptions {
    double target_height = 0.0; ///< above the ground, true metres
    /// Horizontal, metres: samples farther away count as hidden.
    double max_distance = std::numeric_limits<double>::infinity();
    ParallelOptions parallel = {};
};

/// What a viewshed says of a sample.
enum class SeenState : std::uint8_t { hidden = 0, unknown = 128, visible = 255 };

/// Which samples an eye sees, each by an exact ray; voids are unknown. `eye`: col, row and height
/// in true metres. Empty after a stop request. Precondition: `placement` and `pyramid` are of these
/// heights, and the eye is finite.
std::optional<Grid<std::uint8_t>> viewshed(const Heightfield& heightfield,
                                           const MinMaxPyramid& pyramid, const Placement& placement,
                                           glm::dvec3 eye, const ViewshedOptions& options = {});

} // namespace reljef::terrain
