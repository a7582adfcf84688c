#pragma once

#include <cstddef>
#include <cstdint>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <vector>

#include "engine/core/geometry.h"
#include "engine/scene/graph/mesh.h"

namespace reljef::scene {

/// Where a ray enters a mesh.
struct MeshHit {
    double t = 0.0;           ///< along the ray
    std::size_t triangle = 0; ///< its first index
};

/// The nearest triangle with t in `range` that is seen from outside, of all of them. No ray passes
/// between two triangles that share an edge (Woop et al. 2013, in double precision).
std::optional<MeshHit> first_hit(const Mesh& mesh, const Ray& ray, reljef::Interval range);

/// A binary tree of boxes around the triangles of a mesh, for rays in local metres. Thread-safe.
class MeshTree {
public:
    /// The mesh outlives the tree. After a stop request the tree is of no use.
    explicit MeshTree(const Mesh& mesh, const std::stop_token& stop = {});

    /// As that of the mesh.
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
    class Growth;

    const Mesh& mesh_;
    std::vector<std::uint32_t> order_; // triangles
    std::vector<Branch> branches_;
};

/// The trees of meshes: each is made for the first ray that meets the bounds of its mesh, and goes
/// with the first one that is made after its mesh is gone. Large ones are made in the background:
/// until then, rays test all triangles. Thread-safe.
class MeshTrees {
public:
    MeshTrees() = default;
    MeshTrees(const MeshTrees&) = delete;
    MeshTrees(MeshTrees&&) = delete;
    MeshTrees& operator=(const MeshTrees&) = delete;
    MeshTrees& operator=(MeshTrees&&) = delete;
    ~MeshTrees() { stop_.request_stop(); }

    /// As that of the mesh.
    std::optional<MeshHit> first_hit(const std::shared_ptr<const Mesh>& mesh, const Ray& ray,
                                     reljef::Interval range);

private:
    using Tree = std::shared_ptr<const MeshTree>;
    struct Entry {
        Box bounds;
        Tree tree = nullptr;           // null: not needed yet, or not made yet
        std::future<Tree> making = {}; // in the background
    };
    using Key = std::weak_ptr<const Mesh>;

    Entry& entry_for(const std::shared_ptr<const Mesh>& mesh);
    void make(const std::shared_ptr<const Mesh>& mesh, Entry& entry);

    std::stop_source stop_;
    std::mutex mutex_;
    std::map<Key, Entry, std::owner_less<Key>> entries_;
};

} // namespace reljef::scene
