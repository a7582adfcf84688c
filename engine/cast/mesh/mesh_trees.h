#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/core/result.h"
#include "engine/view/draw_list.h"

namespace reljef::cast {

/// A point of a mesh that a ray meets.
struct MeshHit {
    double t = 0.0;           ///< along the ray
    std::size_t mesh = 0;     ///< of PlacedMeshes::meshes()
    std::size_t triangle = 0; ///< its first index
    glm::dvec2 shares{0.0};   ///< barycentric: of the second and third corner, in the triangle
};

/// A mesh in a frame. Places are metres from the eye.
struct PlacedMesh {
    scene::MeshNode node;
    glm::dmat4 local_from_relative{1.0};
    glm::dmat3 world_from_normal{1.0};
    Box local;           ///< around the mesh, its own metres
    double extent = 0.0; ///< largest distance of its places from its origin, metres
};

/// The meshes of a frame. Rays begin at places relative to the eye. Thread-safe.
class PlacedMeshes {
public:
    /// The seen ones first.
    [[nodiscard]] const std::vector<PlacedMesh>& meshes() const { return meshes_; }

    /// The nearest triangle that a ray meets from outside, with t in `range`. Embree decides which;
    /// of equal ones it is that of the first mesh, then the first triangle. The point on it is
    /// exact in doubles. The bits depend on the ray alone.
    [[nodiscard]] std::optional<MeshHit> first_hit(const Ray& ray, Interval range) const;

    /// Whether a ray meets a triangle, from outside or from inside.
    [[nodiscard]] bool hides(glm::vec3 origin, glm::vec3 direction) const;

private:
    friend class MeshTrees;
    struct Scene; // Embree's
    std::shared_ptr<const Scene> scene_;
    std::vector<PlacedMesh> meshes_;
};

/// Trees over the triangles of meshes (Embree; Wald et al. 2014, "Embree: A Kernel Framework for
/// Efficient CPU Ray Tracing"). Keeps each as long as its mesh exists.
class MeshTrees {
public:
    /// Meshes as seen from an eye, world metres. Fails if there is not enough memory.
    Result<PlacedMeshes> place(std::span<const view::MeshDraw> seen,
                               std::span<const view::MeshDraw> beside, glm::dvec3 eye);

    /// Meshes with a tree.
    [[nodiscard]] std::size_t size() const { return trees_.size(); }

private:
    struct Tree {
        std::weak_ptr<const scene::Mesh> owner;
        std::shared_ptr<const PlacedMeshes::Scene> scene;
        Box bounds; // local metres
    };

    Result<const Tree*> tree_of(const std::shared_ptr<const scene::Mesh>& mesh);

    std::shared_ptr<const PlacedMeshes::Scene> device_; // a scene without content, of the device
    std::map<const scene::Mesh*, Tree> trees_;
};

} // namespace reljef::cast
