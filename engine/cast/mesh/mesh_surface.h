#pragma once

#include <map>
#include <memory>

#include <glm/vec3.hpp>

#include "engine/cast/mesh/mesh_trees.h"
#include "engine/cast/mesh/picture_levels.h"
#include "engine/core/geometry.h"
#include "engine/core/hit.h"
#include "engine/scene/graph/terrain_node.h"

namespace reljef::cast {

/// A mesh where a ray meets it.
struct MeshSurface {
    glm::vec3 albedo{0.0F};             ///< linear
    glm::vec3 normal{0.0F, 0.0F, 1.0F}; ///< unit vector in the world, between those of the corners
    glm::vec3 face{0.0F, 0.0F, 1.0F};   ///< the same of the triangle, outwards
};

/// A ray from a place relative to the eye, and the changes of its point at the hit to the pixels on
/// the right and below, metres.
struct PixelRay {
    Ray ray;
    glm::dvec3 right{0.0};
    glm::dvec3 down{0.0};
};

/// Keeps the pictures on meshes as long as they exist.
class MeshPictures {
public:
    /// Prepares the pictures of meshes.
    void prepare(const PlacedMeshes& meshes);

    /// Thread-safe. Precondition: prepared for `meshes`.
    [[nodiscard]] MeshSurface at(const PlacedMeshes& meshes, const MeshHit& hit,
                                 const PixelRay& ray) const;

private:
    struct Picture {
        std::weak_ptr<const material::ReliefMaterial> owner;
        std::shared_ptr<const PictureLevels> levels;
    };
    std::map<const material::ReliefMaterial*, Picture> pictures_;
};

/// As in a hit buffer: no place on the terrain; with a detail texture that in it, as the shaders.
Hit shown_hit(const PlacedMesh& mesh, const MeshHit& hit);

} // namespace reljef::cast
