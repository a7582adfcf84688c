#pragma once

#include <limits>
#include <optional>

#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/core/grid.h"
#include "engine/terrain/min_max_pyramid.h"
#include "engine/terrain/placement.h"

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

/// Meets a placed surface with rays in scene metres. Borrows heights, pyramid and placement; what
/// all rays share is found once. Safe to ask from several threads.
class SurfaceCaster {
public:
    /// Precondition: `pyramid` was made from `heights`.
    SurfaceCaster(GridView<const float> heights, const MinMaxPyramid& pyramid,
                  const Placement& placement);

    /// The first crossing from above to below in `range`. Under an ellipsoid placement the ray is
    /// bent in sample coordinates; where it may touch the surface it is followed there in straight
    /// pieces, halved until the middle of each lies within a thousandth of a sample, and of a metre
    /// of height, of its chord; the hit is then moved along the ray itself onto the surface.
    [[nodiscard]] std::optional<SurfaceHit>
    first_hit(const Ray& world_ray,
              Interval range = {0.0, std::numeric_limits<double>::infinity()}) const;

private:
    GridView<const float> heights_;
    const MinMaxPyramid& pyramid_;
    const Placement& placement_;
    Box reach_; // outside it no ray meets the surface
};

/// The first point where a ray in scene metres meets the placed surface: one SurfaceCaster for one
/// ray.
std::optional<SurfaceHit> pick(GridView<const float> heights, const MinMaxPyramid& pyramid,
                               const Placement& placement, const Ray& world_ray);

} // namespace reljef::terrain
