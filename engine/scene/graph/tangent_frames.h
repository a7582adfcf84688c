#pragma once

#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/scene/graph/mesh.h"

namespace reljef::scene {

/// Tangent space of a vertex: orthonormal with its normal.
struct TangentFrame {
    glm::vec3 tangent{1.0F, 0.0F, 0.0F}; ///< unit vector along u
    float handedness = 1.0F; ///< 1 or -1: v grows along handedness · cross(normal, tangent)
    glm::vec2 density{0.0F}; ///< u and v per metre along tangent and bitangent; 0: unknown
};

/// A frame for every vertex: the gradients of the texture coordinates over the triangles around it,
/// weighted by area and made orthogonal to the normal (Gram-Schmidt; Lengyel, Foundations of Game
/// Engine Development 2, ch. 7.5). Without gradients (no area, equal texture coordinates, opposite
/// directions) any frame of the normal with density 0. Always finite. Precondition: the vertex
/// arrays have the same length.
std::vector<TangentFrame> tangent_frames(const Mesh& mesh);

} // namespace reljef::scene
