#pragma once

#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/scene/graph/mesh.h"

namespace reljef::scene {

/// How texture coordinates lie on a surface at a vertex: orthonormal with the vertex's normal.
struct TangentFrame {
    glm::vec3 tangent{1.0F, 0.0F, 0.0F}; ///< unit, across the normal: where u grows
    float handedness = 1.0F; ///< 1 or -1: v grows along handedness · cross(normal, tangent)
    glm::vec2 density{0.0F}; ///< u a metre along the tangent, v a metre across it; 0: unknown
};

/// The direction in which v grows. Precondition: `normal` is that of the frame's vertex.
glm::vec3 bitangent(const TangentFrame& frame, glm::vec3 normal);

/// A frame for every vertex from the gradients of the texture coordinates over the triangles around
/// it, weighted by their areas and made orthogonal to the normal (Gram-Schmidt; Lengyel,
/// Foundations of Game Engine Development 2, ch. 7.5). Where the triangles say nothing (no area,
/// equal texture coordinates, opposite directions) it is any frame of the normal, of density 0.
/// Always finite. Precondition: the vertex arrays have one length.
std::vector<TangentFrame> tangent_frames(const Mesh& mesh);

} // namespace reljef::scene
