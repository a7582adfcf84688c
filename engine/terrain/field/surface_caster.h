#pragma once

#include <limits>
#include <optional>

#include "engine/core/geometry.h"
#include "engine/core/grid.h"
#include "engine/terrain/field/min_max_pyramid.h"
#include "engine/terrain/field/placement.h"
#include "engine/terrain/field/ray_cast.h"

namespace reljef::terrain {

/// Intersects rays in scene metres with a placed surface. Borrows heights, pyramid and placement.
/// Thread-safe.
class SurfaceCaster {
public:
    /// Precondition: `pyramid` was made from `heights`.
    SurfaceCaster(GridView<const float> heights, const MinMaxPyramid& pyramid,
                  const Placement& placement);

    /// The first crossing from above to below in `range`. On an ellipsoid the ray is bent in sample
    /// coordinates. Where it may touch the surface it is halved until the middle of each piece lies
    /// within 0.001 samples and 0.001 m of its chord. The hit then moves along the ray onto the
    /// surface.
    [[nodiscard]] std::optional<SurfaceHit>
    first_hit(const Ray& world_ray,
              Interval range = {0.0, std::numeric_limits<double>::infinity()}) const;

private:
    GridView<const float> heights_;
    const MinMaxPyramid& pyramid_;
    const Placement& placement_;
    Box reach_; // of the surface
};

/// SurfaceCaster::first_hit() for a single ray.
inline std::optional<SurfaceHit> pick(GridView<const float> heights, const MinMaxPyramid& pyramid,
                                      const Placement& placement, const Ray& world_ray) {
    return SurfaceCaster(heights, pyramid, placement).first_hit(world_ray);
}

} // namespace reljef::terrain
