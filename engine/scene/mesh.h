#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"

namespace reljef::scene {

/// Triangles in local metres. All three vertex arrays have one length; every three indices are one
/// triangle, counter-clockwise from the outside.
struct Mesh {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals; ///< unit length
    std::vector<glm::vec2> texture_coordinates;
    std::vector<std::uint32_t> indices;
};

/// The box around the positions.
Box bounds_of(const Mesh& mesh);

/// A box centred at the origin; `size` in metres along x, y, z.
Mesh box_mesh(glm::vec3 size);

/// A sphere centred at the origin, `segments` around and half as many from pole to pole (at least
/// 3).
Mesh sphere_mesh(float radius, int segments = 48);

} // namespace reljef::scene
