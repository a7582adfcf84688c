#include "engine/scene/graph/camera.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace reljef::scene {
namespace {

// The unit vector, or `otherwise` if the length is zero or not finite.
glm::dvec3 direction_or(glm::dvec3 vector, glm::dvec3 otherwise) {
    const double length = glm::length(vector);
    return std::isfinite(length) && length > 0.0 ? vector / length : otherwise;
}

// A smaller sine between two unit vectors makes them parallel: their cross product has fewer than
// half of a double's 53 bits.
constexpr double parallel_sine = 0x1p-26;

} // namespace

ViewAxes view_axes(const Camera& camera) {
    const glm::dvec3 forward = direction_or(camera.target - camera.eye, {0.0, 1.0, 0.0});
    const glm::dvec3 upward = direction_or(camera.up, {0.0, 0.0, 1.0});
    glm::dvec3 right = glm::cross(forward, upward);
    if (glm::length(right) < parallel_sine) {
        right = glm::cross(forward, glm::dvec3(0.0, 1.0, 0.0));
    }
    if (glm::length(right) < parallel_sine) {
        right = glm::cross(forward, glm::dvec3(1.0, 0.0, 0.0));
    }
    right = glm::normalize(right);
    return {right, glm::cross(right, forward), forward};
}

glm::dmat4 view_from_world_rotation(const Camera& camera) {
    const ViewAxes axes = view_axes(camera);
    return glm::transpose(glm::dmat4(glm::dvec4(axes.right, 0.0), glm::dvec4(axes.up, 0.0),
                                     glm::dvec4(-axes.forward, 0.0),
                                     glm::dvec4(0.0, 0.0, 0.0, 1.0)));
}

glm::dmat4 clip_from_view(const Camera& camera, glm::ivec2 size) {
    const double aspect = static_cast<double>(size.x) / size.y;
    const glm::dvec2 shift(2.0 * camera.shift.x / size.x, -2.0 * camera.shift.y / size.y);
    glm::dmat4 clip(0.0);
    if (camera.projection == ProjectionKind::perspective) {
        const double scale = 1.0 / std::tan(0.5 * glm::radians(camera.vertical_fov));
        clip[0][0] = scale / aspect;
        clip[1][1] = scale;
        clip[2][0] = shift.x;
        clip[2][1] = shift.y;
        clip[3][2] = camera.near;
        clip[2][3] = -1.0;
        return clip;
    }
    const double depth = camera.orthographic_far - camera.orthographic_near;
    clip[0][0] = 2.0 / (camera.view_height * aspect);
    clip[1][1] = 2.0 / camera.view_height;
    clip[2][2] = 1.0 / depth;
    clip[3][0] = -shift.x;
    clip[3][1] = -shift.y;
    clip[3][2] = camera.orthographic_far / depth;
    clip[3][3] = 1.0;
    return clip;
}

namespace {

// Makes the picture `factor` times as high, around its middle.
Camera with_height(Camera camera, double factor) {
    const double half = std::tan(0.5 * glm::radians(camera.vertical_fov));
    camera.vertical_fov = 2.0 * glm::degrees(std::atan(half * factor));
    camera.view_height *= factor;
    return camera;
}

} // namespace

Camera part_camera(Camera camera, glm::ivec2 picture, const PicturePart& part) {
    camera = with_height(camera, static_cast<double>(part.size.y) / picture.y);
    camera.shift += glm::dvec2(part.first) + 0.5 * glm::dvec2(part.size - picture);
    camera.whole = picture;
    camera.first = part.first;
    return camera;
}

Camera camera_of_whole(Camera camera, glm::ivec2 size) {
    if (camera.whole == glm::ivec2(0)) {
        return camera;
    }
    camera.shift -= glm::dvec2(camera.first) + 0.5 * glm::dvec2(size - camera.whole);
    camera = with_height(camera, static_cast<double>(camera.whole.y) / size.y);
    camera.whole = camera.first = glm::ivec2(0);
    return camera;
}

Camera with_fitted_depth(Camera camera, const Box& bounds) {
    if (!bounds.empty()) {
        const glm::dvec3 forward = view_axes(camera).forward;
        const double middle = glm::dot(bounds.center() - camera.eye, forward);
        const double reach = 0.5 * glm::length(bounds.size()) + 1.0;
        camera.orthographic_near = middle - reach;
        camera.orthographic_far = middle + reach;
    }
    return camera;
}

glm::dmat4 clip_from_world(const Camera& camera, glm::ivec2 size) {
    glm::dmat4 relative_from_world(1.0);
    relative_from_world[3] = glm::dvec4(-camera.eye, 1.0);
    return clip_from_view(camera, size) * view_from_world_rotation(camera) * relative_from_world;
}

Ray view_ray(const Camera& camera, glm::ivec2 size, glm::dvec2 pixel) {
    const ViewAxes axes = view_axes(camera);
    const glm::dvec2 place = pixel + camera.shift;
    const double x = 2.0 * place.x / size.x - 1.0;
    const double y = 1.0 - 2.0 * place.y / size.y;
    const double aspect = static_cast<double>(size.x) / size.y;
    if (camera.projection == ProjectionKind::perspective) {
        const double half = std::tan(0.5 * glm::radians(camera.vertical_fov));
        return {camera.eye, axes.forward + half * (aspect * x * axes.right + y * axes.up)};
    }
    const double half = 0.5 * camera.view_height;
    return {camera.eye + half * (aspect * x * axes.right + y * axes.up), axes.forward};
}

Projected project(const Camera& camera, glm::ivec2 size, glm::dvec3 world) {
    const ViewAxes axes = view_axes(camera);
    const glm::dvec3 relative = world - camera.eye;
    const double depth = glm::dot(relative, axes.forward);
    const double half = camera.projection == ProjectionKind::perspective
                            ? depth * std::tan(0.5 * glm::radians(camera.vertical_fov))
                            : 0.5 * camera.view_height;
    const double aspect = static_cast<double>(size.x) / size.y;
    const double x = glm::dot(relative, axes.right) / (half * aspect);
    const double y = glm::dot(relative, axes.up) / half;
    const glm::dvec2 place(0.5 * (x + 1.0) * size.x, 0.5 * (1.0 - y) * size.y);
    return {place - camera.shift, depth};
}

glm::vec2 metres_a_pixel(const Camera& camera, glm::ivec2 size) {
    if (camera.projection == ProjectionKind::orthographic) {
        return {camera.view_height / size.y, 0.0};
    }
    return {0.0, 2.0 * std::tan(0.5 * glm::radians(camera.vertical_fov)) / size.y};
}

Camera camera_from_angles(glm::dvec3 eye, double heading, double pitch, const Compass& compass) {
    const glm::dvec3 upward = direction_or(compass.up, {0.0, 0.0, 1.0});
    const glm::dvec3 east = direction_or(glm::cross(compass.north, upward), {1.0, 0.0, 0.0});
    const glm::dvec3 north = glm::cross(upward, east);
    const double h = glm::radians(heading);
    const double p = glm::radians(pitch);
    const glm::dvec3 ahead = std::sin(h) * east + std::cos(h) * north;
    Camera camera;
    camera.eye = eye;
    camera.target = eye + std::cos(p) * ahead + std::sin(p) * upward;
    camera.up = std::cos(p) * upward - std::sin(p) * ahead;
    return camera;
}

double heading_of(glm::dvec3 direction, const Compass& compass) {
    const ViewAxes level = view_axes(camera_from_angles(glm::dvec3(0.0), 0.0, 0.0, compass));
    return glm::degrees(
        std::atan2(glm::dot(direction, level.right), glm::dot(direction, level.forward)));
}

ViewAngles angles_of(const Camera& camera, const Compass& compass) {
    const ViewAxes axes = view_axes(camera);
    const double rise = std::clamp(glm::dot(axes.forward, compass.up), -1.0, 1.0);
    const bool is_upright = glm::length(glm::cross(axes.forward, compass.up)) >= parallel_sine;
    const glm::dvec3 ahead = is_upright ? axes.forward : -std::copysign(1.0, rise) * axes.up;
    return {heading_of(ahead, compass), glm::degrees(std::asin(rise))};
}

} // namespace reljef::scene
