#pragma once

#include <limits>
#include <optional>

#include "engine/core/geometry.h"
#include "engine/core/grid.h"
#include "engine/terrain/field/min_max_pyramid.h"
#include "engine/terrain/field/placement.h"
#include "engine/terrain/field/ray_cast.h"

namespace reljef::terrain {

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
