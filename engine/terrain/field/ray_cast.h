#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/core/grid.h"
#include "engine/terrain/field/min_max_pyramid.h"

namespace reljef::terrain {

/// The intersection of a ray with a bilinear height surface.
struct SurfaceHit {
    double t = 0.0;         ///< along the ray
    glm::dvec3 sample{0.0}; ///< col, row, height (metres)
};

/// The first crossing from above to below of a ray in sample coordinates (col, row, height) with
/// the bilinear surface. The pyramid skips blocks that the ray cannot touch (Tevs et al. 2008). In
/// each cell the crossing is the exact root of a quadratic in t. A ray that enters beneath the
/// surface at the border continues to a front face. A ray that is not finite has no hit.
/// Precondition: `pyramid` was made from `heights`.
std::optional<SurfaceHit> first_hit(GridView<const float> heights, const MinMaxPyramid& pyramid,
                                    const Ray& sample_ray, Interval range);

/// Side of the surface that a ray is on.
enum class Side { unknown, above, below };

struct Stretch {
    std::optional<SurfaceHit> hit;
    Side side = Side::unknown; ///< at the end
};

/// As first_hit() for a piece of a ray that was on `side` before. A piece that is not over the grid
/// keeps its side. Precondition: finite.
Stretch follow(GridView<const float> heights, const MinMaxPyramid& pyramid, const Ray& sample_ray,
               Interval range, Side side);

} // namespace reljef::terrain
