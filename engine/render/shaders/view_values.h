#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/scene/graph/camera.h"

namespace reljef::render {

// Inputs of programs, computed in double precision.

bool is_perspective(const scene::Camera& camera);

/// The view ray at depth 1 is gl_FragCoord · xy + zw. `size` in pixels.
glm::vec4 ray_from_pixel(const scene::Camera& camera, glm::ivec2 size);

glm::dvec3 local_eye(const scene::Camera& camera, const glm::dmat4& world_from_local);

/// From the local frame to world axes with the eye as origin.
glm::mat4 relative_from_local(const scene::Camera& camera, const glm::dmat4& world_from_local);

glm::mat3 world_from_normal(const glm::dmat4& world_from_local);

} // namespace reljef::render
