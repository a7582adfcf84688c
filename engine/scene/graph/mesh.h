#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"

namespace reljef::scene {

/// Triangles in local metres. The three vertex arrays have the same length. Three indices each are
/// one triangle, counter-clockwise from outside.
struct Mesh {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals; ///< unit length
    std::vector<glm::vec2> texture_coordinates;
    std::vector<std::uint32_t> indices;
};

Box bounds_of(const Mesh& mesh);

/// A corner of a triangle and its edges to the other two.
struct TriangleEdges {
    glm::dvec3 corner{0.0}; ///< metres, as p and q
    glm::dvec3 p{0.0};
    glm::dvec3 q{0.0};
    glm::dvec2 coordinate{0.0}; ///< texture coordinate, as s and t
    glm::dvec2 s{0.0};
    glm::dvec2 t{0.0};
};
/// `first`: the first of the triangle's indices.
TriangleEdges triangle_edges(const Mesh& mesh, std::size_t first);

/// The corners of a triangle, `first`: the first of its indices; metres.
std::array<glm::dvec3, 3> triangle_corners(const Mesh& mesh, std::size_t first);

/// The point of a triangle that is nearest to another point. The triangle may be a line or a point.
glm::dvec3 nearest_point(const std::array<glm::dvec3, 3>& triangle, glm::dvec3 point);

/// A mesh that may be drawn instead of another one.
struct MeshLevel {
    std::shared_ptr<const Mesh> mesh;
    /// No point of either mesh is farther from some point of the other one, local metres; proven.
    double error = 0.0;
    /// Longest edge of its triangles whose normals differ visibly from the mesh's, local metres.
    double shaded_width = 0.0;
    /// For a mesh with a picture: local metres after which the picture repeats. The level shows it
    /// at other places, so it is for views in which a repeat is smaller than half a pixel, where
    /// all show its mean. 0: it shows the picture at the same places. Absent: for plain meshes
    /// only.
    std::optional<double> repeat = std::nullopt;
    /// For meshes that were proven together, as the walls and roofs of houses: the bounds of all of
    /// them, local metres. Their levels are chosen by this box, and so together, if their nodes
    /// have one place, error, width and repeat. Empty: for a mesh of its own.
    Box together = {};
};
/// From fine to coarse, with growing errors.
using MeshLevels = std::vector<MeshLevel>;

/// The plane of a flat mesh with its texture coordinates: local metres.
struct TexturePlane {
    glm::dvec3 origin{0.0};  ///< at texture coordinate 0
    glm::dvec3 along_u{0.0}; ///< per unit of u
    glm::dvec3 along_v{0.0};
    glm::dvec3 normal{0.0}; ///< unit length, outwards
    glm::dvec2 low{0.0};    ///< smallest texture coordinates of the mesh
    glm::dvec2 high{0.0};
};

/// Empty if the mesh is not flat, or its texture coordinates are not affine.
std::optional<TexturePlane> texture_plane(const Mesh& mesh);

// Shapes: seen from outside, an image with row 0 at v = 0 is upright and not mirrored. `segments`
// around are at least 3.

/// A level rectangle around the origin, seen from above: `size` in metres along x and y; u grows
/// with x, v against y, 0 to 1.
Mesh plane_mesh(glm::vec2 size);

/// A standing rectangle around the origin: `size` in metres along x and z, seen from −y; u grows
/// with x, v against z, 0 to 1. Its normals point up: as a billboard (facing.h), it has the light
/// of level ground, from wherever it is seen.
Mesh billboard_mesh(glm::vec2 size);

/// A box centred at the origin; `size` in metres along x, y, z; u and v from 0 to 1 on each side.
Mesh box_mesh(glm::vec3 size);

/// A sphere centred at the origin with half as many segments from pole to pole; u once around, v
/// from the upper pole to the lower one.
Mesh sphere_mesh(float radius, int segments = 48);

/// The lower half of a sphere, open on top: its rim lies at z = 0. A quarter as many segments from
/// the rim to the pole; u once around, v from the rim down.
Mesh bowl_mesh(float radius, int segments = 48);

/// A torus around the z axis with half as many segments around the tube; u once around the axis, v
/// once around the tube, from inside over the top.
Mesh torus_mesh(float ring_radius, float tube_radius, int segments = 64);

/// A closed cylinder around the z axis, centred at the origin. On the wall u goes once around and v
/// from the top down; the ends have the same density of texture coordinates.
Mesh cylinder_mesh(float radius, float height, int segments = 48);

} // namespace reljef::scene
