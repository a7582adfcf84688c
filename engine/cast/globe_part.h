#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/geo/georeference.h"
#include "engine/terrain/field/placement.h"

namespace reljef::cast {

/// What may be seen of a terrain that covers all longitudes, up to the horizon.
struct GlobePart {
    Box local; ///< around the ground, metres
    /// Columns continue beyond the terrain's; where a pole or ground behind one may be seen, they
    /// go twice around.
    Box samples;
    bool has_north_pole = false; ///< ground there may be seen
    bool has_south_pole = false;
};

/// `samples`: of all ground, with even rows (EarthMap), and metres of height. `eye`: local metres.
/// Empty: the eye is below all ground. Preconditions: a placement on the ellipsoid, whose columns
/// go all around.
std::optional<GlobePart> globe_part_from(glm::dvec3 eye, const terrain::Placement& placement,
                                         const geo::WrappedRows& rows, const Box& samples);

/// Parallel rays up to a distance from the one in their middle, local metres.
struct ParallelRays {
    Ray middle;
    double radius = 0.0;
};

/// What parallel rays may show.
GlobePart globe_part_along(const ParallelRays& rays, const terrain::Placement& placement,
                           const geo::WrappedRows& even_rows, const Box& samples);

} // namespace reljef::cast
