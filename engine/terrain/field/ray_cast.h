#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/core/grid.h"
#include "engine/terrain/field/min_max_pyramid.h"

namespace reljef::terrain {

/// Where a ray meets a bilinear height surface.
struct SurfaceHit {
    double t = 0.0;         ///< along the ray
    glm::dvec3 sample{0.0}; ///< col, row, height (metres)
};

/// The first crossing from above to below of a ray given in sample coordinates (col, row, height; t
/// in [begin, end]) with the bilinear surface of `heights`. The ray is walked cell by cell below
/// the blocks of the pyramid that it can touch; in each cell the surface along the ray is a
/// quadratic in t and is solved as one: no marching, no tolerance. A ray that enters beneath the
/// surface at the border goes on until it meets a front face (Tevs et al. 2008 for the traversal).
/// A ray that is not finite meets nothing. Precondition: `pyramid` was made from `heights`.
std::optional<SurfaceHit> first_hit(GridView<const float> heights, const MinMaxPyramid& pyramid,
                                    const Ray& sample_ray, Interval range);

/// On which side of the surface a ray is.
enum class Side { unknown, above, below };

/// What a stretch of a ray met, and on which side of the surface it was left.
struct Stretch {
    std::optional<SurfaceHit> hit;
    Side side = Side::unknown;
};

/// As first_hit, of a ray that was on `side` before its range begins: for rays that are followed
/// piece by piece. Not over the grid at all, it keeps its side. Precondition: finite.
Stretch follow(GridView<const float> heights, const MinMaxPyramid& pyramid, const Ray& sample_ray,
               Interval range, Side side);

} // namespace reljef::terrain
