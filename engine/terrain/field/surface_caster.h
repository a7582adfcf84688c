#pragma once

#include <limits>
#include <optional>

#include "engine/core/geometry.h"
#include "engine/core/grid.h"
#include "engine/terrain/field/min_max_pyramid.h"
#include "engine/terrain/field/placement.h"
#include "engine/terrain/field/ray_cast.h"
#include "engine/terrain/field/surface_ray.h"

namespace reljef::terrain {

/// Intersects rays in scene metres with a placed surface. Borrows heights, pyramid and placement.
/// Thread-safe.
class SurfaceCaster {
public:
    /// Precondition: `pyramid` was made from `heights`.
    SurfaceCaster(GridView<const float> heights, const MinMaxPyramid& pyramid,
                  const Placement& placement);

    /// The first crossing from above to below in `range`; see SurfaceRay.
    [[nodiscard]] std::optional<SurfaceHit>
    first_hit(const Ray& world_ray,
              Interval range = {0.0, std::numeric_limits<double>::infinity()}) const;

private:
    SurfaceTile tile_;
    const Placement& placement_;
    Box reach_; // of the surface
    Box shell_; // of all terrain there may be
};

/// A box around a placed surface with heights up to max_height_on_ellipsoid, or up to the next
/// power of two above those of `heights`: equal for terrains over the same area.
Box shell_around(const TiledSurface& surface, MinMax heights = {0.0F, 0.0F});

/// Metres, above and below the ellipsoid or geoid.
inline constexpr float max_height_on_ellipsoid = 65536.0F;

/// The straight ray in sample coordinates on a plane. Empty on an ellipsoid, and for a tile whose
/// map is not affine: with shorter last cells, or of a terrain that covers all longitudes.
std::optional<Ray> sample_ray_on_plane(const Placement& placement, const Ray& world_ray);

/// SurfaceCaster::first_hit() for a single ray.
inline std::optional<SurfaceHit> pick(GridView<const float> heights, const MinMaxPyramid& pyramid,
                                      const Placement& placement, const Ray& world_ray) {
    return SurfaceCaster(heights, pyramid, placement).first_hit(world_ray);
}

} // namespace reljef::terrain
