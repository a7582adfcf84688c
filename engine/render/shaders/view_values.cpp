#include "engine/render/shaders/view_values.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_inverse.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

namespace reljef::render {

bool is_perspective(const scene::Camera& camera) {
    return camera.projection == scene::ProjectionKind::perspective;
}

namespace {

// At depth 1, along right and up.
struct RayOfPixel {
    glm::dvec2 a_pixel; // change per pixel
    glm::dvec2 corner;
};

RayOfPixel ray_of_pixel(const scene::Camera& camera, glm::ivec2 size) {
    const glm::dvec2 pixels(size);
    const double half = std::tan(0.5 * glm::radians(camera.vertical_fov));
    const glm::dvec2 extent{half * pixels.x / pixels.y, half};
    const glm::dvec2 a_pixel = 2.0 * extent / pixels;
    const glm::dvec2 shift = a_pixel * glm::dvec2(camera.shift.x, -camera.shift.y);
    return {a_pixel, shift - extent};
}

} // namespace

glm::vec4 ray_from_pixel(const scene::Camera& camera, glm::ivec2 size) {
    const RayOfPixel ray = ray_of_pixel(camera, size);
    return glm::vec4(glm::vec2(ray.a_pixel), glm::vec2(ray.corner));
}

int guard_factor(glm::ivec2 size) {
    constexpr int farthest = 8192; // pixels; see on_vertex_grid() in terrain.vert
    const int times = farthest / std::max(size.x, size.y);
    return std::max(times % 2 == 0 ? times - 1 : times, 1);
}

glm::dmat3 relative_from_pixel(const scene::Camera& camera, glm::ivec2 size) {
    const scene::ViewAxes axes = scene::view_axes(camera);
    const RayOfPixel ray = ray_of_pixel(camera, size);
    return {ray.a_pixel.x * axes.right, ray.a_pixel.y * axes.up,
            ray.corner.x * axes.right + ray.corner.y * axes.up + axes.forward};
}

glm::dvec3 local_eye(const scene::Camera& camera, const glm::dmat4& world_from_local) {
    return glm::dvec3(glm::inverse(world_from_local) * glm::dvec4(camera.eye, 1.0));
}

glm::mat4 relative_from_local(const scene::Camera& camera, const glm::dmat4& world_from_local) {
    glm::dmat4 relative = world_from_local;
    relative[3] -= glm::dvec4(camera.eye, 0.0);
    return glm::mat4(relative);
}

glm::mat3 world_from_normal(const glm::dmat4& world_from_local) {
    return glm::mat3(glm::inverseTranspose(glm::dmat3(world_from_local)));
}

} // namespace reljef::render
