#include "engine/view/error_view.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "engine/core/check.h"

// A pixel shows a point A of a triangle that belongs at B = A + D. With the view's right, up and
// forward axes A = (Ax, Ay, Az), and with f pixels to a radian at the middle of the picture
//   |project(B) - project(A)| = f |(Dx, Dy) Az - (Ax, Ay) Dz| / (Az Bz),
// the first two components of a cross product: at most f |D × A| / (Az Bz). That holds wherever on
// the picture A is, and wherever its middle is. On a plane D is vertical, so |D × A| is |D| times
// A's horizontal distance from the eye; else at most |D| times its distance.

namespace reljef::view {
namespace {

// The most that a transform lengthens anything.
double greatest_stretch(const glm::dmat3& axes) {
    const std::array squares{glm::dot(axes[0], axes[0]), glm::dot(axes[1], axes[1]),
                             glm::dot(axes[2], axes[2])};
    const double sum = squares[0] + squares[1] + squares[2];
    // Columns that are orthogonal up to the rounding of doubles.
    const double skew =
        std::max({std::abs(glm::dot(axes[0], axes[1])), std::abs(glm::dot(axes[1], axes[2])),
                  std::abs(glm::dot(axes[2], axes[0]))});
    constexpr double rounding = 0x1p-40;
    return skew <= rounding * sum
               ? std::sqrt(*std::max_element(squares.begin(), squares.end()) + 2.0 * skew)
               : std::sqrt(sum); // the Frobenius norm
}

glm::dmat3 cross_with(glm::dvec3 v) {
    return {0.0, v.z, -v.y, -v.z, 0.0, v.x, v.y, -v.x, 0.0};
}

glm::dvec4 unit_side(glm::dvec4 side) {
    return side / glm::length(glm::dvec3(side));
}

// Left, right, bottom, top and near side of what is seen (Gribb and Hartmann 2001).
std::array<glm::dvec4, 5> seen_sides(const glm::dmat4& clip_from_local) {
    const glm::dmat4 rows = glm::transpose(clip_from_local);
    return {unit_side(rows[3] + rows[0]), unit_side(rows[3] - rows[0]),
            unit_side(rows[3] + rows[1]), unit_side(rows[3] - rows[1]),
            unit_side(rows[3] - rows[2])};
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
    view.stretch = greatest_stretch(axes);
    view.sides = seen_sides(scene::clip_from_world(camera, size) * world_from_local);
    view.depth = glm::dvec4(glm::transpose(axes) * forward, glm::dot(forward, offset));
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

} // namespace reljef::view
