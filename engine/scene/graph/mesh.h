#pragma once

#include <cstddef>
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

/// One corner of a triangle, and the ways from it to the other two.
struct TriangleEdges {
    glm::dvec3 corner{0.0}; ///< metres, as p and q
    glm::dvec3 p{0.0};
    glm::dvec3 q{0.0};
    glm::dvec2 coordinate{0.0}; ///< of the texture, as s and t
    glm::dvec2 s{0.0};
    glm::dvec2 t{0.0};
};
/// Of the triangle whose indices begin at `first`.
TriangleEdges triangle_edges(const Mesh& mesh, std::size_t first);

// The shapes' texture coordinates: a picture whose row 0 is at v = 0 stands upright and is not
// mirrored, seen from outside.

/// A level rectangle around the origin, seen from above: `size` in metres along x and y; u grows
/// with x, v against y, 0 to 1.
Mesh plane_mesh(glm::vec2 size);

/// A box centred at the origin; `size` in metres along x, y, z; each side u and v from 0 to 1.
Mesh box_mesh(glm::vec3 size);

/// A sphere centred at the origin, `segments` around and half as many from pole to pole (at least
/// 3); u once around, v from the upper pole to the lower.
Mesh sphere_mesh(float radius, int segments = 48);

/// The lower half of such a sphere, open on top: its rim lies at z = 0. `segments` around and a
/// quarter as many from the rim to the pole (at least 3); u once around, v from the rim down.
Mesh bowl_mesh(float radius, int segments = 48);

/// A torus around the z axis: its tube of `tube_radius` runs `ring_radius` away from the origin.
/// `segments` around the axis and half as many around the tube (at least 3); u once around the
/// axis, v once around the tube, from inside over the top.
Mesh torus_mesh(float ring_radius, float tube_radius, int segments = 64);

/// A closed cylinder around the z axis, centred at the origin; `segments` around (at least 3). On
/// the wall u goes once around and v from the top down; on the ends they go as far a metre.
Mesh cylinder_mesh(float radius, float height, int segments = 48);

} // namespace reljef::scene
