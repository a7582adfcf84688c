#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "engine/core/geometry.h"
#include "engine/scene/graph/mesh.h"

namespace reljef::scene {

/// Where a ray enters a mesh.
struct MeshHit {
    double t = 0.0;           ///< along the ray
    std::size_t triangle = 0; ///< its first index
};

/// A binary tree of boxes around the triangles of a mesh, for rays in local metres. Thread-safe.
class MeshTree {
public:
    /// The mesh outlives the tree.
    explicit MeshTree(const Mesh& mesh);

    /// The nearest triangle with t in `range` that is seen from outside. No ray passes between two
    /// triangles that share an edge (Woop et al. 2013, in double precision).
    [[nodiscard]] std::optional<MeshHit> first_hit(const Ray& ray, reljef::Interval range) const;

    /// The first index of a triangle that no other one is nearer to a point than. `guess`: the
    /// first index of any triangle; a near one makes it fast. Precondition: the mesh has triangles.
    [[nodiscard]] std::size_t nearest_triangle(glm::dvec3 point, std::size_t guess = 0) const;

    [[nodiscard]] const Mesh& mesh() const { return mesh_; }

private:
    struct Branch {
        Box bounds;
        std::uint32_t first = 0;  // of `order_`
        std::uint32_t count = 0;  // 0: two branches follow, the next one and `second`
        std::uint32_t second = 0; // of `branches_`
    };
    void grow(const std::vector<Box>& boxes, std::size_t begin, std::size_t end);

    const Mesh& mesh_;
    std::vector<std::uint32_t> order_; // triangles
    std::vector<Branch> branches_;
};

/// The trees of meshes: each is made for the first ray that meets the bounds of its mesh, and goes
/// with the first one that is made after its mesh is gone. Thread-safe.
class MeshTrees {
public:
    /// As MeshTree::first_hit().
    std::optional<MeshHit> first_hit(const std::shared_ptr<const Mesh>& mesh, const Ray& ray,
                                     reljef::Interval range);

private:
    struct Entry {
        Box bounds;
        std::shared_ptr<const MeshTree> tree; // null: not needed yet
    };
    using Key = std::weak_ptr<const Mesh>;

    std::shared_ptr<const MeshTree> tree_for(const std::shared_ptr<const Mesh>& mesh,
                                             const Ray& ray, reljef::Interval range);

    std::mutex mutex_;
    std::map<Key, Entry, std::owner_less<Key>> entries_;
};

} // namespace reljef::scene
