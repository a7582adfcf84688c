#include "bench/suites/frame_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/matrix.hpp>

namespace reljef::bench {

bool enters_above(const scene::TerrainSurface& surface, const Ray& ray, double metres) {
    Box column = surface.bounds();
    column.low.z = -max_world_coordinate;
    column.high.z = max_world_coordinate;
    const auto inside = intersect(ray, column);
    if (!inside || inside->begin == 0.0) {
        return inside.has_value();
    }
    const glm::dvec3 entry = glm::clamp(ray.at(inside->begin), column.low, column.high);
    return entry.z > surface.height_at(entry.x, entry.y).value_or(column.high.z) + metres;
}

void FrameErrors::add(const FrameErrors& other) {
    pixels += other.pixels;
    violations += other.violations;
    holes += other.holes;
    worst = std::max(worst, other.worst);
}

FrameChecker::FrameChecker(const scene::TerrainSurface& surface, const glm::dmat4& world_from_local,
                           glm::ivec2 size, ParallelOptions parallel)
    : surface_(surface), world_from_local_(world_from_local), size_(size),
      parallel_(std::move(parallel)) {}

FrameErrors FrameChecker::check_frame(const scene::Camera& camera, const HitBuffer& hits,
                                      double stated, const PixelLattice& lattice) const {
    const int rows = (size_.y - lattice.first.y + lattice.step - 1) / lattice.step;
    std::vector<FrameErrors> parts(static_cast<std::size_t>(rows));
    const truth::SurfaceView view{surface_.heightfield().heights.view(), surface_.placement(),
                                  world_from_local_, camera};
    parallel_for(
        rows,
        [&](int index) {
            const int y = lattice.first.y + index * lattice.step;
            for (int x = lattice.first.x; x < size_.x; x += lattice.step) {
                check_pixel(view, {x, y}, hits(x, y), stated,
                            parts[static_cast<std::size_t>(index)]);
            }
        },
        parallel_);
    FrameErrors all;
    for (const FrameErrors& part : parts) {
        all.add(part);
    }
    return all;
}

void FrameChecker::check_pixel(const truth::SurfaceView& view, glm::ivec2 pixel, const Hit& hit,
                               double stated, FrameErrors& errors) const {
    if (!truth::shows_terrain(hit)) {
        errors.holes += is_hole(view.camera, pixel, stated) ? 1U : 0U;
        return;
    }
    const double error = truth::reprojection_error(view, size_, pixel, hit);
    ++errors.pixels;
    errors.violations += error <= stated ? 0 : 1;
    errors.worst = std::max(errors.worst, error);
}

// Whether the exact rays around the pixel, up to farther away than the stated error, all hit
// terrain, and none of its ends is as near. Otherwise a silhouette may have moved within that
// error, or an end that a silhouette just hid. A ray that enters beneath the border sees ground
// only where it comes out from beneath: between two such places there may be none.
bool FrameChecker::is_hole(const scene::Camera& camera, glm::ivec2 pixel, double stated) const {
    const double reach = stated + 1.0;
    const bool is_on_plane = surface_.placement().kind() == terrain::PlacementKind::plane;
    if (is_on_plane && !enters_above(surface_, local_ray(camera, glm::dvec2(pixel) + 0.5))) {
        return false;
    }
    return is_surrounded(camera, pixel, reach, 3) && is_surrounded(camera, pixel, reach, 9) &&
           distance_to_end(camera, pixel) > reach;
}

Ray FrameChecker::local_ray(const scene::Camera& camera, glm::dvec2 place) const {
    const Ray world = scene::view_ray(camera, size_, place);
    const glm::dmat4 local_from_world = glm::inverse(world_from_local_);
    return {glm::dvec3(local_from_world * glm::dvec4(world.origin, 1.0)),
            glm::dvec3(local_from_world * glm::dvec4(world.direction, 0.0))};
}

// By `side` × `side` rays.
bool FrameChecker::is_surrounded(const scene::Camera& camera, glm::ivec2 pixel, double reach,
                                 int side) const {
    const glm::dvec2 first = glm::dvec2(pixel) + 0.5 - reach;
    const double step = 2.0 * reach / (side - 1);
    for (int i = 0; i < side * side; ++i) {
        const glm::dvec2 place = first + step * glm::dvec2(i % side, i / side);
        if (!surface_.pick(local_ray(camera, place))) {
            return false;
        }
    }
    return true;
}

// Distance of a pixel to the lines between the samples at the ends of the terrain, pixels.
double FrameChecker::distance_to_end(const scene::Camera& camera, glm::ivec2 pixel) const {
    const auto& heights = surface_.heightfield().heights;
    const glm::ivec2 last(heights.cols() - 1, heights.rows() - 1);
    const auto world = [&](glm::ivec2 sample) {
        const glm::dvec3 local =
            surface_.placement().world_from_sample({sample, heights(sample.x, sample.y)});
        return glm::dvec3(world_from_local_ * glm::dvec4(local, 1.0));
    };
    double nearest = std::numeric_limits<double>::infinity();
    const auto visit = [&](glm::ivec2 first, glm::ivec2 step, int count) {
        glm::dvec3 before = world(first);
        for (int i = 1; i <= count; ++i) {
            const glm::dvec3 now = world(first + i * step);
            nearest = std::min(nearest, distance_to_line(camera, pixel, before, now));
            before = now;
        }
    };
    visit({0, 0}, {1, 0}, last.x);
    visit({0, last.y}, {1, 0}, last.x);
    visit({0, 0}, {0, 1}, last.y);
    visit({last.x, 0}, {0, 1}, last.y);
    return nearest;
}

// On the picture, the distance to a point that moves along a line has one minimum.
double FrameChecker::distance_to_line(const scene::Camera& camera, glm::ivec2 pixel,
                                      glm::dvec3 first, glm::dvec3 last) const {
    const auto distance_at = [&](double part) {
        return truth::distance_to_pixel(camera, size_, pixel, glm::mix(first, last, part));
    };
    constexpr int thirds = 24; // (2/3)^24: a 10,000th of the line
    double low = 0.0;
    double high = 1.0;
    for (int i = 0; i < thirds; ++i) {
        const double third = (high - low) / 3.0;
        if (distance_at(low + third) < distance_at(high - third)) {
            high -= third;
        } else {
            low += third;
        }
    }
    return std::min({distance_at(0.0), distance_at(0.5 * (low + high)), distance_at(1.0)});
}

} // namespace reljef::bench
