#include "engine/cast/picture_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/core/check.h"

namespace reljef::cast {
namespace {

bool is_perspective(const scene::Camera& camera) {
    return camera.projection == scene::ProjectionKind::perspective;
}

// Directions in samples from local ones: the placement on a plane is affine.
glm::dmat3 samples_from_local(const terrain::Placement& placement) {
    const glm::dvec2 spacing = placement.spacing();
    return {{1.0 / spacing.x, 0.0, 0.0},
            {0.0, -1.0 / spacing.y, 0.0},
            {0.0, 0.0, 1.0 / placement.exaggeration()}};
}

PictureRays::Vectors linear(glm::dvec3 first, glm::dvec3 right, glm::dvec3 down, glm::ivec2 size) {
    return {first, (right - first) / static_cast<double>(size.x),
            (down - first) / static_cast<double>(size.y)};
}

glm::dvec3 corner_of(const Box& box, int index) {
    return {(index & 1) != 0 ? box.high.x : box.low.x, (index & 2) != 0 ? box.high.y : box.low.y,
            (index & 4) != 0 ? box.high.z : box.low.z};
}

// The smallest depth in the box: the depth of a place is linear in its coordinates. In perspective
// its rays begin at the eye.
double depth_of(const Box& bounds, const PictureRays& rays, bool perspective) {
    const PictureRays::Vectors& fan = perspective ? rays.direction : rays.origin;
    const glm::dvec3 across = glm::cross(fan.right, fan.down);
    const glm::dvec3 along = across / glm::dot(across, rays.direction.first);
    double nearest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 8; ++i) {
        nearest = std::min(nearest, glm::dot(along, corner_of(bounds, i) - rays.origin.first));
    }
    const double depth = perspective ? std::max(nearest, 0.0) : nearest;
    return std::isfinite(depth) ? depth : rays.range.begin;
}

} // namespace

PictureRays picture_rays(const scene::Camera& camera, glm::ivec2 size,
                         const glm::dmat4& world_from_local, const terrain::Placement& placement,
                         const Box& bounds) {
    check(placement.kind() == terrain::PlacementKind::plane, "rays over the curved Earth");
    const glm::dmat4 local_from_world = glm::inverse(world_from_local);
    const glm::dmat3 sample_from_world =
        samples_from_local(placement) * glm::dmat3(local_from_world);
    const auto ray_at = [&](glm::dvec2 pixel) {
        const Ray ray = scene::view_ray(camera, size, pixel);
        const glm::dvec3 local(local_from_world * glm::dvec4(ray.origin, 1.0));
        return Ray{placement.sample_from_world(local).value_or(glm::dvec3(0.0)),
                   sample_from_world * ray.direction};
    };
    const Ray first = ray_at({0.0, 0.0});
    const Ray right = ray_at({size.x, 0.0});
    const Ray down = ray_at({0.0, size.y});
    PictureRays rays;
    rays.size = size;
    rays.origin = linear(first.origin, right.origin, down.origin, size);
    rays.direction = linear(first.direction, right.direction, down.direction, size);
    rays.range = is_perspective(camera)
                     ? Interval{camera.near, std::numeric_limits<double>::infinity()}
                     : Interval{camera.orthographic_near, camera.orthographic_far};
    rays.anchor = depth_of(bounds, rays, is_perspective(camera));
    return rays;
}

} // namespace reljef::cast
