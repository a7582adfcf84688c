#pragma once

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/trigonometric.hpp>

#include "engine/terrain/field/placement.h"

namespace reljef::session {

/// The columns are the axes of what stands at a place, in scene metres: z is the local vertical,
/// and y points `heading` degrees clockwise from north.
inline glm::dmat3 upright_axes(const terrain::Placement& placement, glm::dvec3 ground,
                               double heading = 0.0) {
    const glm::dvec3 up = placement.up(ground);
    const glm::dvec3 north = placement.north(ground);
    const glm::dvec3 east = glm::cross(north, up);
    const double angle = glm::radians(heading);
    return {std::cos(angle) * east - std::sin(angle) * north,
            std::cos(angle) * north + std::sin(angle) * east, up};
}

} // namespace reljef::session
