#pragma once

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

/// The first point where a ray in scene metres meets the placed surface. Under an ellipsoid
/// placement the ray is bent in sample coordinates; it is followed there in straight pieces, halved
/// until the middle of each lies within a thousandth of a sample, and of a metre of height, of its
/// chord.
std::optional<SurfaceHit> pick(GridView<const float> heights, const MinMaxPyramid& pyramid,
                               const Placement& placement, const Ray& world_ray);

} // namespace reljef::terrain
