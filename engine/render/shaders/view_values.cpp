#include "engine/render/shaders/view_values.h"

#include <cmath>

#include <glm/gtc/matrix_inverse.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

namespace reljef::render {

bool is_perspective(const scene::Camera& camera) {
    return camera.projection == scene::ProjectionKind::perspective;
}

glm::vec4 ray_from_pixel(const scene::Camera& camera, glm::ivec2 size) {
    const glm::dvec2 pixels(size);
    const double half = std::tan(0.5 * glm::radians(camera.vertical_fov));
    const glm::dvec2 extent{half * pixels.x / pixels.y, half};
    const glm::dvec2 a_pixel = 2.0 * extent / pixels;
    const glm::dvec2 shift = a_pixel * glm::dvec2(camera.shift.x, -camera.shift.y);
    return glm::vec4(glm::vec2(a_pixel), glm::vec2(shift - extent));
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
