#pragma once

#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/result.h"
#include "engine/gl/texture.h"
#include "engine/render/residency/resident_mesh.h"
#include "engine/render/residency/tile_residency.h"
#include "engine/view/draw_list.h"
#include "engine/view/frame_stats.h"

namespace reljef::render {

/// The tetrahedra of a hull (hull_mesh.h), one an instance.
struct ResidentHull {
    gl::Buffer parts;
    gl::VertexArray vertex_array;
    int count = 0;
    glm::vec4 coordinate_range{0.0F}; ///< of the texture where it is lowest: least, greatest
};

/// What of the meshes is in the driver's memory: triangles, tiles of detail, displaced triangles.
/// Only what is drawn gets there, and stays while the scene holds it; displaced triangles while
/// they are drawn. Needs a current context; destroy while it is current.
class MeshResidency {
public:
    /// Fails when the driver has no memory left.
    Result<void> prepare(const std::vector<view::MeshDraw>& draws, const scene::Camera& camera,
                         view::FrameStats& stats);

    /// Precondition: prepared.
    [[nodiscard]] const ResidentMesh& mesh(const view::MeshDraw& draw) const;
    [[nodiscard]] const ResidentTile& tile(const view::MeshDraw& draw) const;
    [[nodiscard]] const ResidentSurface& surface(const view::MeshDraw& draw) const;
    /// Precondition: prepared, with silhouettes.
    [[nodiscard]] const ResidentHull& hull(const view::MeshDraw& draw) const;
    /// What prewarp shows on the mesh: warped_tile; null for other techniques.
    [[nodiscard]] const gl::Texture2D* warp(const view::MeshDraw& draw) const;

private:
    enum class Look { plain, textured }; // which attributes its vertices have
    struct Triangles {
        std::weak_ptr<const scene::Mesh> owner;
        ResidentMesh resident;
    };
    struct Displaced {
        std::weak_ptr<const scene::Mesh> owner;
        scene::SurfaceDetail detail;
        double texels = 0.0;
        ResidentMesh resident;
        bool drawn = false;
    };

    struct Hull {
        std::weak_ptr<const scene::Mesh> owner;
        scene::SurfaceDetail detail;
        ResidentHull resident;
        bool drawn = false;
    };

    [[nodiscard]] const Hull* find_hull(const view::MeshDraw& draw) const;
    Result<void> prepare_hull(const view::MeshDraw& draw, view::FrameStats& stats);
    [[nodiscard]] const Displaced* displaced(const view::MeshDraw& draw) const;
    void forget_unused(const std::vector<view::MeshDraw>& draws);
    Result<void> prepare_triangles(const view::MeshDraw& draw, view::FrameStats& stats);
    Result<void> prepare_displaced(const view::MeshDraw& draw, view::FrameStats& stats);
    Result<void> prepare_warps(const std::vector<view::MeshDraw>& draws,
                               const scene::Camera& camera, view::FrameStats& stats);

    std::map<std::pair<const scene::Mesh*, Look>, Triangles> triangles_;
    std::vector<Displaced> displaced_;
    std::vector<Hull> hulls_;
    TileResidency tiles_;
    std::map<const scene::MeshNode*, gl::Texture2D> warps_; // of the last frame
};

} // namespace reljef::render
