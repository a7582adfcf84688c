#include "engine/view/error_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "engine/core/check.h"

// A pixel shows a point A of a triangle, which belongs at B = A + D. Along the view's right, up and
// forward axes A = (Ax, Ay, Az). With f pixels per radian at the middle of the picture
//   |project(B) - project(A)| = f |(Dx, Dy) Az - (Ax, Ay) Dz| / (Az Bz).
// The numerator is two components of a cross product, so this is at most f |D × A| / (Az Bz),
// wherever A is on the picture. On a plane D is vertical, and |D × A| is |D| times A's horizontal
// distance from the eye; otherwise it is at most |D| times A's distance.

namespace reljef::view {
namespace {

// Bounds the factor by which a transform lengthens a vector.
double max_stretch(const glm::dmat3& axes) {
    const std::array squares{glm::dot(axes[0], axes[0]), glm::dot(axes[1], axes[1]),
                             glm::dot(axes[2], axes[2])};
    const double sum = squares[0] + squares[1] + squares[2];
    const double skew =
        std::max({std::abs(glm::dot(axes[0], axes[1])), std::abs(glm::dot(axes[1], axes[2])),
                  std::abs(glm::dot(axes[2], axes[0]))});
    constexpr double rounding = 0x1p-40; // orthogonal columns up to the rounding of doubles
    return skew <= rounding * sum
               ? std::sqrt(*std::max_element(squares.begin(), squares.end()) + 2.0 * skew)
               : std::sqrt(sum); // the Frobenius norm
}

glm::dmat3 cross_with(glm::dvec3 v) {
    return {0.0, v.z, -v.y, -v.z, 0.0, v.x, v.y, -v.x, 0.0};
}

// Left, right, bottom, top and near plane of the frustum (Gribb and Hartmann 2001), with unit
// normals.
std::array<glm::dvec4, 5> frustum_sides(const glm::dmat4& clip_from_local) {
    const glm::dmat4 rows = glm::transpose(clip_from_local);
    std::array<glm::dvec4, 5> sides{rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1],
                                    rows[3] - rows[1], rows[3] - rows[2]};
    for (glm::dvec4& side : sides) {
        side /= glm::length(glm::dvec3(side));
    }
    return sides;
}

// Whether the transform keeps lengths and angles.
bool is_rigid(const glm::dmat4& transform) {
    constexpr double rounding = 0x1p-40;
    const glm::dmat3 axes(transform);
    const glm::dmat3 product = glm::transpose(axes) * axes;
    double deviation = 0.0;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            deviation = std::max(deviation, std::abs(product[i][j] - (i == j ? 1.0 : 0.0)));
        }
    }
    return deviation <= rounding;
}

} // namespace

terrain::ErrorView error_view(const scene::Camera& camera, glm::ivec2 size,
                              const glm::dmat4& world_from_local, terrain::PlacementKind kind,
                              double max_error) {
    check(max_error > rasterizer_error, "an error that no rasterizer can keep");
    const glm::dvec3 forward = scene::view_axes(camera).forward;
    const glm::dmat3 axes(world_from_local);
    const glm::dvec3 offset = glm::dvec3(world_from_local[3]) - camera.eye;
    const bool is_vertical = kind == terrain::PlacementKind::plane;
    terrain::ErrorView view;
    view.max_error = max_error - rasterizer_error;
    view.perspective = camera.projection == scene::ProjectionKind::perspective;
    view.stretch = max_stretch(axes);
    view.sides = frustum_sides(scene::clip_from_world(camera, size) * world_from_local);
    view.depth = glm::dvec4(glm::transpose(axes) * forward, glm::dot(forward, offset));
    view.near = camera.near;
    const glm::dvec3 metre_up = axes[2];
    if (!view.perspective) {
        const double across = glm::length(metre_up - forward * glm::dot(forward, metre_up));
        view.scale = size.y / camera.view_height * (is_vertical ? across : view.stretch);
        return view;
    }
    const double focal = 0.5 * size.y / std::tan(0.5 * glm::radians(camera.vertical_fov));
    view.scale = focal * (is_vertical ? glm::length(metre_up) : view.stretch);
    const glm::dmat3 lateral = is_vertical ? cross_with(glm::normalize(metre_up)) : glm::dmat3(1.0);
    view.lateral_axes = lateral * axes;
    view.lateral_origin = lateral * offset;
    return view;
}

PictureError::PictureError(const scene::Camera& camera, glm::ivec2 size,
                           const glm::dmat4& world_from_local, terrain::PlacementKind kind)
    : view_(error_view(camera, size, world_from_local, kind, 1.0)),
      world_from_local_(world_from_local), eye_(camera.eye), near_(camera.near),
      is_vertical_(kind == terrain::PlacementKind::plane) {
    const double half_height = std::tan(0.5 * glm::radians(camera.vertical_fov));
    corner_angle_ = std::atan(half_height * glm::length(glm::dvec2(size)) / size.y);
}

// As above, with A and B in the box. A is visible, so that its depth is at least its distance times
// the cosine of the corner's angle, and |D × A| is at most |D| Az over the cosine of its own angle.
double PictureError::in_box(const Box& box, double error) const {
    if (!view_.perspective || error == 0.0) {
        return view_.scale * error;
    }
    const glm::dvec3 middle = box.center();
    const glm::dvec3 half = 0.5 * box.size();
    const glm::dvec3 forward(view_.depth);
    const double depth_of_middle = glm::dot(forward, middle) + view_.depth.w;
    const Box bounds = transformed(world_from_local_, box);
    const double distance = glm::distance(eye_, glm::clamp(eye_, bounds.low, bounds.high));
    const double depth = std::max({depth_of_middle - glm::dot(glm::abs(forward), half),
                                   distance * std::cos(corner_angle_), near_});
    const double depth_of_true_place = depth - view_.stretch * error;
    if (!(depth_of_true_place > 0.0)) {
        return std::numeric_limits<double>::infinity();
    }
    const double distance_of_middle = glm::distance(eye_, bounds.center());
    const double radius = 0.5 * glm::length(bounds.size());
    const double angle =
        radius < distance_of_middle
            ? std::acos(std::clamp(depth_of_middle / distance_of_middle, -1.0, 1.0)) +
                  std::asin(radius / distance_of_middle)
            : corner_angle_;
    const double lateral =
        glm::length(view_.lateral_axes * middle + view_.lateral_origin) +
        view_.stretch * (is_vertical_ ? glm::length(glm::dvec2(half)) : glm::length(half));
    return view_.scale * error / depth_of_true_place *
           std::min(1.0 / std::cos(std::min(angle, corner_angle_)), lateral / depth);
}

std::optional<terrain::HorizonView> horizon_view(const scene::Camera& camera, glm::ivec2 size,
                                                 const glm::dmat4& world_from_local, double error) {
    if (camera.projection != scene::ProjectionKind::perspective || !is_rigid(world_from_local)) {
        return std::nullopt;
    }
    const double half_height = std::tan(0.5 * glm::radians(camera.vertical_fov));
    const double focal = 0.5 * size.y / half_height; // pixels per radian, at least
    const double half_width = half_height * size.x / size.y;
    constexpr double rasterized = 1.0; // pixels between a pixel's ray and its corners
    terrain::HorizonView view;
    view.eye = glm::dvec3(glm::inverse(world_from_local) * glm::dvec4(camera.eye, 1.0));
    view.near = camera.near * std::sqrt(1.0 + half_height * half_height + half_width * half_width);
    view.margin = (error + rasterized) / focal;
    return view;
}

} // namespace reljef::view
