#include "engine/core/geometry.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace reljef {
namespace {

// At most; exact for orthogonal columns.
double stretch_along_columns(const glm::dmat3& map) {
    const glm::dvec3 squares(glm::dot(map[0], map[0]), glm::dot(map[1], map[1]),
                             glm::dot(map[2], map[2]));
    const double sum = squares.x + squares.y + squares.z;
    const double skew =
        std::max({std::abs(glm::dot(map[0], map[1])), std::abs(glm::dot(map[1], map[2])),
                  std::abs(glm::dot(map[2], map[0]))});
    constexpr double rounding = 0x1p-40; // orthogonal columns up to the rounding of doubles
    return skew <= rounding * sum
               ? std::sqrt(std::max({squares.x, squares.y, squares.z}) + 2.0 * skew)
               : std::sqrt(sum); // the Frobenius norm
}

} // namespace

SplitPoint split_into_floats(glm::dvec3 point) {
    const glm::dvec3 rounded(rounded_to_float(point.x), rounded_to_float(point.y),
                             rounded_to_float(point.z));
    return {glm::vec3(rounded), glm::vec3(point - rounded)};
}

void Box::add(glm::dvec3 point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
}

void Box::add(const Box& box) {
    low = glm::min(low, box.low);
    high = glm::max(high, box.high);
}

Box transformed(const glm::dmat4& to_from_local, const Box& box) {
    if (box.empty()) {
        return {};
    }
    // Arvo 1990: each axis contributes separately. The order of the sums is that of a matrix-vector
    // product, so the result equals the transformed corners bit for bit.
    std::array<Box, 3> moved;
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3 low = glm::dvec3(to_from_local[axis]) * box.low[axis];
        const glm::dvec3 high = glm::dvec3(to_from_local[axis]) * box.high[axis];
        moved[static_cast<std::size_t>(axis)] = {glm::min(low, high), glm::max(low, high)};
    }
    const glm::dvec3 origin(to_from_local[3]);
    return {(moved[0].low + moved[1].low) + (moved[2].low + origin),
            (moved[0].high + moved[1].high) + (moved[2].high + origin)};
}

double max_stretch(const glm::dmat3& map) {
    // Of a map and of its transpose the largest factor is the same.
    return std::min(stretch_along_columns(map), stretch_along_columns(glm::transpose(map)));
}

bool is_finite(const Ray& ray) {
    const auto finite = [](glm::dvec3 v) {
        return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    };
    return finite(ray.origin) && finite(ray.direction);
}

std::optional<Interval> intersect(const Ray& ray, const Box& box, Interval range) {
    if (box.empty()) {
        return std::nullopt;
    }
    for (int axis = 0; axis < 3; ++axis) {
        if (ray.direction[axis] == 0.0) {
            if (ray.origin[axis] < box.low[axis] || ray.origin[axis] > box.high[axis]) {
                return std::nullopt;
            }
            continue;
        }
        const double t0 = (box.low[axis] - ray.origin[axis]) / ray.direction[axis];
        const double t1 = (box.high[axis] - ray.origin[axis]) / ray.direction[axis];
        range.begin = std::max(range.begin, std::min(t0, t1));
        range.end = std::min(range.end, std::max(t0, t1));
    }
    return range.begin <= range.end ? std::optional(range) : std::nullopt;
}

Frustum::Frustum(const glm::dmat4& clip_from_world) {
    const glm::dmat4 rows = glm::transpose(clip_from_world);
    planes_ = {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1],
               rows[3] - rows[1], rows[2],           rows[3] - rows[2]};
}

Frustum Frustum::in_local(const glm::dmat4& world_from_local) const {
    Frustum local = *this;
    for (glm::dvec4& plane : local.planes_) {
        plane = plane * world_from_local;
    }
    return local;
}

bool Frustum::may_see(const Box& box) const {
    return !box.empty() &&
           std::none_of(planes_.begin(), planes_.end(), [&](const glm::dvec4& plane) {
               const glm::dvec3 farthest{plane.x >= 0.0 ? box.high.x : box.low.x,
                                         plane.y >= 0.0 ? box.high.y : box.low.y,
                                         plane.z >= 0.0 ? box.high.z : box.low.z};
               return glm::dot(glm::dvec3(plane), farthest) + plane.w < 0.0;
           });
}

} // namespace reljef
