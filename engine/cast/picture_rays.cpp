#include "engine/cast/picture_rays.h"

#include <algorithm>
#include <array>
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

double anchor_of(const Box& bounds, const PictureRays& rays, bool perspective) {
    const double nearest = depths_of(bounds, rays, perspective).begin;
    const double depth = perspective ? std::max(nearest, 0.0) : nearest;
    return std::isfinite(depth) ? depth : rays.range.begin;
}

Interval range_of(const scene::Camera& camera) {
    return is_perspective(camera) ? Interval{camera.near, std::numeric_limits<double>::infinity()}
                                  : Interval{camera.orthographic_near, camera.orthographic_far};
}

// `ray_at`: of a place on the picture.
template <class RayAt> PictureRays rays_through(glm::ivec2 size, const RayAt& ray_at) {
    const Ray first = ray_at({0.0, 0.0});
    const Ray right = ray_at({size.x, 0.0});
    const Ray down = ray_at({0.0, size.y});
    PictureRays rays;
    rays.size = size;
    rays.origin = linear(first.origin, right.origin, down.origin, size);
    rays.direction = linear(first.direction, right.direction, down.direction, size);
    return rays;
}

PictureRays::Vectors moved(const PictureRays::Vectors& vectors, glm::dvec2 scale, glm::dvec2 by) {
    const glm::dvec3 factor(scale, 1.0);
    PictureRays::Vectors found{vectors.first * factor + glm::dvec3(by, 0.0), vectors.right * factor,
                               vectors.down * factor};
    for (std::size_t i = 0; i < found.bends.size(); ++i) {
        found.bends[i] = vectors.bends[i] * factor;
    }
    return found;
}

// a + factor · b.
PictureRays::Vectors sum_of(const PictureRays::Vectors& a, double factor,
                            const PictureRays::Vectors& b) {
    PictureRays::Vectors sum{a.first + factor * b.first, a.right + factor * b.right,
                             a.down + factor * b.down};
    for (std::size_t i = 0; i < sum.bends.size(); ++i) {
        sum.bends[i] = a.bends[i] + factor * b.bends[i];
    }
    return sum;
}

// Halfway between the best plane through the corners and the parallel one through the middle.
PictureRays::Vectors plane_near(const PictureRays::Vectors& vectors, glm::ivec2 first,
                                glm::ivec2 size) {
    const glm::dvec2 middle = glm::dvec2(first) + 0.5 * glm::dvec2(size);
    const auto at = [&](double x, double y) {
        return vectors.at(middle + glm::dvec2(x, y) * glm::dvec2(size));
    };
    const std::array corner{at(-0.5, -0.5), at(0.5, -0.5), at(-0.5, 0.5), at(0.5, 0.5)};
    PictureRays::Vectors found;
    found.right =
        0.5 * (corner[1] - corner[0] + corner[3] - corner[2]) / static_cast<double>(size.x);
    found.down =
        0.5 * (corner[2] - corner[0] + corner[3] - corner[1]) / static_cast<double>(size.y);
    const glm::dvec3 mean = 0.25 * (corner[0] + corner[1] + corner[2] + corner[3]);
    found.first = 0.5 * (mean + at(0.0, 0.0)) - middle.x * found.right - middle.y * found.down;
    return found;
}

} // namespace

// The depth of a place is linear in its coordinates. In perspective the rays begin at the eye.
Interval depths_of(const Box& bounds, const PictureRays& rays, bool is_perspective) {
    const PictureRays::Vectors& fan = is_perspective ? rays.direction : rays.origin;
    const glm::dvec3 across = glm::cross(fan.right, fan.down);
    const glm::dvec3 along = across / glm::dot(across, rays.direction.first);
    Interval depths{std::numeric_limits<double>::infinity(),
                    -std::numeric_limits<double>::infinity()};
    for (int i = 0; i < 8; ++i) {
        const double depth = glm::dot(along, corner_of(bounds, i) - rays.origin.first);
        depths = {std::min(depths.begin, depth), std::max(depths.end, depth)};
    }
    return depths;
}

PictureRays::Vectors places_at(const PictureRays& rays, double t) {
    return sum_of(rays.origin, t, rays.direction);
}

PictureRays straight_between(const PictureRays::Vectors& from, const PictureRays::Vectors& to,
                             Interval depths, const PictureRays& like) {
    const double length = depths.end - depths.begin;
    PictureRays rays = like;
    rays.range = depths;
    rays.direction = sum_of({}, 1.0 / length, sum_of(to, -1.0, from));
    rays.origin = from;
    rays.origin = places_at(rays, -depths.begin);
    return rays;
}

PictureRays made_linear(PictureRays rays, glm::ivec2 first, glm::ivec2 size) {
    const PictureRays::Vectors from = plane_near(places_at(rays, rays.range.begin), first, size);
    const PictureRays::Vectors to = plane_near(places_at(rays, rays.range.end), first, size);
    return straight_between(from, to, rays.range, rays);
}

PictureRays in_samples(PictureRays rays, glm::dvec2 scale, glm::dvec2 by) {
    rays.origin = moved(rays.origin, scale, by);
    rays.direction = moved(rays.direction, scale, glm::dvec2(0.0));
    return rays;
}

PictureRays local_rays(const scene::Camera& camera, glm::ivec2 size,
                       const glm::dmat4& world_from_local, const Box& bounds) {
    const glm::dmat4 local_from_world = glm::inverse(world_from_local);
    PictureRays rays = rays_through(size, [&](glm::dvec2 pixel) {
        const Ray ray = scene::view_ray(camera, size, pixel);
        return Ray{glm::dvec3(local_from_world * glm::dvec4(ray.origin, 1.0)),
                   glm::dmat3(local_from_world) * ray.direction};
    });
    rays.range = range_of(camera);
    rays.anchor = anchor_of(bounds, rays, is_perspective(camera));
    return rays;
}

glm::dvec3 direction_in_samples(const terrain::Placement& placement, glm::dvec3 local) {
    return samples_from_local(placement) * local;
}

PictureRays picture_rays(const scene::Camera& camera, glm::ivec2 size,
                         const glm::dmat4& world_from_local, const terrain::Placement& placement,
                         const Box& bounds) {
    check(placement.kind() == terrain::PlacementKind::plane, "rays over the curved Earth");
    const glm::dmat4 local_from_world = glm::inverse(world_from_local);
    const glm::dmat3 sample_from_world =
        samples_from_local(placement) * glm::dmat3(local_from_world);
    PictureRays rays = rays_through(size, [&](glm::dvec2 pixel) {
        const Ray ray = scene::view_ray(camera, size, pixel);
        const glm::dvec3 local(local_from_world * glm::dvec4(ray.origin, 1.0));
        return Ray{placement.sample_from_world(local).value_or(glm::dvec3(0.0)),
                   sample_from_world * ray.direction};
    });
    rays.range = range_of(camera);
    rays.anchor = anchor_of(bounds, rays, is_perspective(camera));
    return rays;
}

} // namespace reljef::cast
