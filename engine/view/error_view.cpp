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

// Floats round the place of a vertex in a few steps: relative to the eye, in the world's axes, in
// the picture, and on the rasterizer's grid. Each is a share of its distance from the eye, which
// the picture shows as at most f / cos^2(a) pixels, where a is the angle of the picture's corner
// from its middle; without perspective, as the distance times the pixels per metre. The corners of
// a triangle in a sphere of radius r are up to 2 r farther away than a point of it that is seen at
// a depth of z, and rounded by up to 2 r / z times as much more. So triangles are split until that
// is a small share of the bound.
//
// A pixel shows a point A of a triangle, which belongs at B = A + D. Along the view's right, up and
// forward axes A = (Ax, Ay, Az). With f pixels per radian at the middle of the picture
//   |project(B) - project(A)| = f |(Dx, Dy) Az - (Ax, Ay) Dz| / (Az Bz).
// The numerator is two components of a cross product, so this is at most f |D × A| / (Az Bz),
// wherever A is on the picture. On a plane D is vertical, and |D × A| is |D| times A's horizontal
// distance from the eye; otherwise it is at most |D| times A's distance.

namespace reljef::view {
namespace {

// The operations that round a vertex one after the other: 3 relative to the eye, 4 and 5 for two
// matrices, 4 for the grid, 8 for places that are interpolated from there.
constexpr double rounded_vertex = 24.0 * 0x1p-24;
// Shares of the bound. For places that are interpolated within triangles: with a smaller share,
// more triangles are slivers (triangles/slivers.h).
constexpr double interpolation_share = 1.0 / 64.0;
// For corners beside the picture: with a smaller share, triangles at the eye are smaller.
constexpr double corner_share = 1.0 / 64.0;
// For triangles, at least: better ones would hardly change the picture.
constexpr double min_left = 0.5;

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

bool is_perspective(const scene::Camera& camera) {
    return camera.projection == scene::ProjectionKind::perspective;
}

// At the middle of the picture.
double pixels_per_radian(const scene::Camera& camera, glm::ivec2 size) {
    return 0.5 * size.y / std::tan(0.5 * glm::radians(camera.vertical_fov));
}

// Pixels, at most.
double rounding_of_vertices(const scene::Camera& camera, glm::ivec2 size) {
    const double diagonal = glm::length(glm::dvec2(scene::whole_picture(camera, size))); // pixels
    if (is_perspective(camera)) {
        const double focal = pixels_per_radian(camera, size);
        return rounded_vertex * (focal + 0.25 * diagonal * diagonal / focal);
    }
    const double pixels_per_metre = size.y / camera.view_height;
    const double farthest =
        std::max(std::abs(camera.orthographic_near), std::abs(camera.orthographic_far));
    return rounded_vertex * (pixels_per_metre * farthest + 0.5 * diagonal);
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

BoundLeft left_of_bound(const scene::Camera& camera, glm::ivec2 size, double max_error) {
    check(max_error > rasterizer_error, "an error that no rasterizer can keep");
    const double interpolation = interpolation_share * max_error;
    const double corners = is_perspective(camera) ? corner_share * max_error : 0.0;
    const double of_operations = rounding_of_vertices(camera, size);
    const double rounding = of_operations + interpolation + corners;
    const double min_error_left = min_left * (max_error - rasterizer_error);
    const double left = max_error - rasterizer_error - rounding;
    // The sum of all parts, rounded, is within the bound, too.
    return {.error = std::max(left, min_error_left) * (1.0 - 0x1p-50),
            .vertex_rounding = rounding,
            .of_operations = of_operations,
            .corner_rounding = corners,
            .interpolation = interpolation_error + interpolation,
            .exceeded_by_rounding = left < min_error_left};
}

terrain::ErrorView error_view(const scene::Camera& camera, glm::ivec2 size,
                              const glm::dmat4& world_from_local, terrain::PlacementKind kind,
                              double max_error) {
    const glm::dvec3 forward = scene::view_axes(camera).forward;
    const glm::dmat3 axes(world_from_local);
    const glm::dvec3 offset = glm::dvec3(world_from_local[3]) - camera.eye;
    const bool is_vertical = kind == terrain::PlacementKind::plane;
    terrain::ErrorView view;
    const BoundLeft left = left_of_bound(camera, size, max_error);
    view.max_error = left.error;
    view.vertex_rounding = left.vertex_rounding;
    view.interpolation = left.interpolation;
    view.exceeded_by_rounding = left.exceeded_by_rounding;
    view.perspective = is_perspective(camera);
    view.stretch = max_stretch(axes);
    // Those of the whole picture: triangles beside a part divide others in it.
    view.sides = frustum_sides(scene::clip_from_world(scene::camera_of_whole(camera, size),
                                                      scene::whole_picture(camera, size)) *
                               world_from_local);
    view.depth = glm::dvec4(glm::transpose(axes) * forward, glm::dot(forward, offset));
    view.near = camera.near;
    const glm::dvec3 metre_up = axes[2];
    if (!view.perspective) {
        const double across = glm::length(metre_up - forward * glm::dot(forward, metre_up));
        view.scale = size.y / camera.view_height * (is_vertical ? across : view.stretch);
        return view;
    }
    const double focal = pixels_per_radian(camera, size);
    view.scale = focal * (is_vertical ? glm::length(metre_up) : view.stretch);
    const double to_corner = // of the picture, over the focal length
        0.5 * glm::length(glm::dvec2(scene::whole_picture(camera, size))) / focal;
    view.distance_per_depth = std::sqrt(1.0 + to_corner * to_corner);
    view.rounding_between = 2.0 * rounding_of_vertices(camera, size);
    view.max_rounding = left.corner_rounding;
    const glm::dmat3 lateral = is_vertical ? cross_with(glm::normalize(metre_up)) : glm::dmat3(1.0);
    view.lateral_axes = lateral * axes;
    view.lateral_origin = lateral * offset;
    return view;
}

WiderPicture wider_picture(scene::Camera camera, glm::ivec2 size, double margin) {
    const glm::ivec2 wider = size + 2 * static_cast<int>(std::ceil(margin));
    const double growth = static_cast<double>(wider.y) / size.y;
    camera.view_height *= growth;
    camera.whole += camera.whole == glm::ivec2(0) ? glm::ivec2(0) : wider - size;
    camera.vertical_fov =
        glm::degrees(2.0 * std::atan(growth * std::tan(0.5 * glm::radians(camera.vertical_fov))));
    return {camera, wider};
}

PictureError::PictureError(const scene::Camera& camera, glm::ivec2 size,
                           const glm::dmat4& world_from_local)
    : world_from_local_(world_from_local), axes_(scene::view_axes(camera)), eye_(camera.eye),
      near_(camera.near), stretch_(max_stretch(glm::dmat3(world_from_local))) {
    if (camera.projection == scene::ProjectionKind::orthographic) {
        corner_angle_ = 0.0;
        pixels_per_metre_ = size.y / camera.view_height;
        return;
    }
    const double half_height = std::tan(0.5 * glm::radians(camera.vertical_fov));
    // That of the whole picture: all parts select the same.
    const glm::dvec2 whole(scene::whole_picture(camera, size));
    corner_angle_ = std::atan(half_height * glm::length(whole) / size.y);
    pixels_per_metre_ = 0.5 * size.y / half_height;
}

PictureError::Seen PictureError::seen(const Box& box) const {
    const Box bounds = transformed(world_from_local_, box);
    Seen seen{bounds.center() - eye_, 0.5 * glm::length(bounds.size()), corner_angle_, near_};
    const double distance_of_middle = glm::length(seen.to_middle);
    if (seen.radius < distance_of_middle) {
        const double cosine = glm::dot(axes_.forward, seen.to_middle) / distance_of_middle;
        seen.angle = std::min(seen.angle, std::acos(std::clamp(cosine, -1.0, 1.0)) +
                                              std::asin(seen.radius / distance_of_middle));
    }
    const double distance = glm::distance(eye_, glm::clamp(eye_, bounds.low, bounds.high));
    const double depth_of_box = glm::dot(axes_.forward, seen.to_middle) -
                                0.5 * glm::dot(glm::abs(axes_.forward), bounds.size());
    seen.depth = std::max({distance * std::cos(seen.angle), depth_of_box, near_});
    return seen;
}

// As above, with a visible A in the box and D = error · u. Over Az, the numerator is
//   |(ux, uy) - uz (Ax, Ay) / Az|,
// at most |(ux, uy)| + |uz| tan(a), where a is A's angle from the middle of the picture. With the
// box's middle M, |(Ax, Ay)/Az - (Mx, My)/Mz| is at most |A - M| / Az · |M| / Mz, which is smaller
// if the box is. Where the vertical turns by t, D changes by t · error, and this by at most
// t / cos(a). Az is at least A's distance times cos(a), and the box's depth.
double PictureError::of(const Places& places) const {
    const double error = stretch_ * places.error;
    if (error == 0.0 || corner_angle_ == 0.0) {
        return pixels_per_metre_ * error;
    }
    const auto [to_middle, radius, angle, depth] = seen(places.box);
    const glm::dvec3 up = glm::normalize(glm::dmat3(world_from_local_) * places.up);
    const glm::dvec2 across(glm::dot(axes_.right, up), glm::dot(axes_.up, up));
    const double along = glm::dot(axes_.forward, up);
    const double depth_of_true_place = depth - error * (std::abs(along) + places.turn);
    if (!(depth_of_true_place > 0.0)) {
        return std::numeric_limits<double>::infinity();
    }
    double moved = glm::length(across) + std::abs(along) * std::tan(angle);
    const double depth_of_middle = glm::dot(axes_.forward, to_middle);
    if (depth_of_middle > 0.0) {
        const glm::dvec2 middle =
            glm::dvec2(glm::dot(axes_.right, to_middle), glm::dot(axes_.up, to_middle)) /
            depth_of_middle;
        const double beside = radius / depth * (glm::length(to_middle) / depth_of_middle);
        moved = std::min(moved, glm::length(across - along * middle) + std::abs(along) * beside);
    }
    return pixels_per_metre_ * error / depth_of_true_place *
           (moved + places.turn / std::cos(angle));
}

// |D x A| is at most |D| |A|, and |A| / Az at most 1 / cos(a).
double PictureError::of_any_direction(const Box& box, double error) const {
    const double in_world = stretch_ * error;
    if (in_world == 0.0 || corner_angle_ == 0.0) {
        return pixels_per_metre_ * in_world;
    }
    const Seen places = seen(box);
    const double depth_of_true_place = places.depth - in_world;
    return depth_of_true_place > 0.0
               ? pixels_per_metre_ * in_world / depth_of_true_place / std::cos(places.angle)
               : std::numeric_limits<double>::infinity();
}

double PictureError::depth_ratio(const Box& box) const {
    if (corner_angle_ == 0.0) {
        return 1.0;
    }
    const Seen places = seen(box);
    return std::max((glm::length(places.to_middle) + places.radius) / places.depth, 1.0);
}

std::optional<terrain::HorizonView> horizon_view(const scene::Camera& camera, glm::ivec2 size,
                                                 const glm::dmat4& world_from_local, double error) {
    if (camera.projection != scene::ProjectionKind::perspective || !is_rigid(world_from_local)) {
        return std::nullopt;
    }
    const double half_height = std::tan(0.5 * glm::radians(camera.vertical_fov));
    const double focal = 0.5 * size.y / half_height; // pixels per radian, at least
    const glm::dvec2 half_sides =
        half_height / size.y * glm::dvec2(scene::whole_picture(camera, size));
    constexpr double rasterized = 1.0; // pixels between a pixel's ray and its corners
    terrain::HorizonView view;
    view.eye = glm::dvec3(glm::inverse(world_from_local) * glm::dvec4(camera.eye, 1.0));
    view.near = camera.near * std::sqrt(1.0 + glm::dot(half_sides, half_sides));
    view.margin = (error + rasterized) / focal;
    return view;
}

} // namespace reljef::view
