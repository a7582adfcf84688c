#pragma once

#include <cstddef>

#include "engine/scene/graph/mesh.h"

namespace reljef::io {

// A mesh whose triangles share no vertices: three of them are a triangle, and it has no indices.

/// Gives each vertex without a normal (its length is 0, no number, or far from 1) the mean of the
/// normals of the triangles that have a corner at the same position and turn by at most `hard_edge`
/// from its own triangle. Normals of triangles without area stay 0. Where triangles of more than
/// max_corner_directions meet, directions within about 15 degrees count as one: so the time grows
/// with the number of vertices only, also where all lie at one position.
/// `hard_edge`: degrees, 0 to 180.
void add_missing_normals(scene::Mesh& corners, float hard_edge);
inline constexpr std::size_t max_corner_directions = 216;

/// The same triangles, in the same order; vertices that are equal in all bits become one.
scene::Mesh joined_corners(const scene::Mesh& corners);

/// Whether a normal is one: its length is near 1.
bool is_normal(glm::vec3 v);

} // namespace reljef::io
