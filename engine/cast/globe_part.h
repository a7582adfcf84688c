#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/terrain/field/placement.h"

namespace reljef::cast {

/// What an eye may see of a terrain that covers all longitudes, up to its horizon. No pole is seen:
/// all columns meet there.
struct GlobePart {
    Box local; ///< around the ground, metres
    /// Columns continue beyond the terrain's; where ground behind a pole may be seen, they go twice
    /// around.
    Box samples;
};

/// `eye`: local metres. `samples`: of all ground, and metres of height. `rows`: those between which
/// rows are equally far apart. Empty: the eye is below the ground, or sees beyond these rows.
/// Preconditions: a placement on the ellipsoid, whose columns go all around.
std::optional<GlobePart> globe_part(const terrain::Placement& placement, glm::dvec3 eye,
                                    const Box& samples, Interval rows);

} // namespace reljef::cast
