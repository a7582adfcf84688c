#pragma once

#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/scene/graph/mesh.h"

namespace reljef::scene {

/// The plane of a flat mesh, by its texture coordinates: local metres.
struct TexturePlane {
    glm::dvec3 origin{0.0};  ///< where they are 0
    glm::dvec3 along_u{0.0}; ///< a unit of the first
    glm::dvec3 along_v{0.0};
    glm::dvec3 normal{0.0}; ///< unit length, off the mesh's outside
    glm::dvec2 low{0.0};    ///< least texture coordinates of the mesh
    glm::dvec2 high{0.0};
};

/// Absent where the mesh is not flat, or its texture coordinates are not spread evenly over it.
std::optional<TexturePlane> texture_plane(const Mesh& mesh);

} // namespace reljef::scene
