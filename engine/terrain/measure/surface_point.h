#pragma once

#include <optional>

#include <glm/vec2.hpp>

#include "engine/terrain/field/heightfield.h"
#include "engine/terrain/field/placement.h"

namespace reljef::terrain {

/// A place of a bilinear surface, in true metres whatever the exaggeration.
struct SurfacePoint {
    double height = 0.0;          ///< metres above the DEM's zero
    double slope = 0.0;           ///< degrees, [0, 90)
    std::optional<double> aspect; ///< downhill, degrees clockwise from north, [0, 360); level: none
    bool is_void = false;         ///< one of the four samples around is a void, which is filled
};

/// At (col, row) of a heightfield: the gradient of its cell. Empty outside, and for numbers that
/// are not finite. Precondition: `placement` places these heights, at least 2×2.
std::optional<SurfacePoint> surface_point(const Heightfield& heightfield,
                                          const Placement& placement, glm::dvec2 sample);

} // namespace reljef::terrain
