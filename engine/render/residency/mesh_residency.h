#pragma once

#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/result.h"
#include "engine/gl/texture.h"
#include "engine/render/residency/tile_residency.h"
#include "engine/render/triangles/resident_mesh.h"
#include "engine/view/draw_list.h"
#include "engine/view/frame_stats.h"

namespace reljef::render {

/// The tetrahedra of a hull (hull_mesh.h), one per instance.
struct ResidentHull {
    gl::Buffer parts;
    gl::VertexArray vertex_array;
    int count = 0;
    glm::vec4 coordinate_range{0.0F}; ///< texture coordinates at the bottom: minimum, maximum
};

/// Meshes in GPU memory: triangles, surface detail, displaced triangles and hulls. Drawn content is
/// uploaded and stays as long as the scene has it; displaced triangles and hulls as long as they
/// are drawn.
class MeshResidency {
public:
    Result<void> prepare(const std::vector<view::MeshDraw>& draws, const scene::Camera& camera,
                         view::FrameStats& stats);

    /// Precondition: prepared.
    [[nodiscard]] const ResidentMesh& mesh(const view::MeshDraw& draw) const;
    [[nodiscard]] const ResidentTile& tile(const view::MeshDraw& draw) const;
    [[nodiscard]] const ResidentSurface& surface(const view::MeshDraw& draw) const;
    /// Precondition: prepared; the technique has silhouettes.
    [[nodiscard]] const ResidentHull& hull(const view::MeshDraw& draw) const;
    /// warped_tile() for prewarp; null for other techniques.
    [[nodiscard]] const gl::Texture2D* warp(const view::MeshDraw& draw) const;

private:
    enum class Look { plain, textured }; // the vertices' attributes
    struct Triangles {
        std::weak_ptr<const scene::Mesh> owner;
        ResidentMesh resident;
    };
    // Geometry made from a mesh, its detail and, for displacement, the edge length in texels.
    template <class Resident> struct Derived {
        std::weak_ptr<const scene::Mesh> owner;
        scene::SurfaceDetail detail;
        double texels = 0.0;
        Resident resident;

        [[nodiscard]] bool is_for(const view::MeshDraw& draw) const;
    };

    Result<void> prepare_hull(const view::MeshDraw& draw, view::FrameStats& stats);
    void forget_unused(const std::vector<view::MeshDraw>& draws);
    Result<void> prepare_triangles(const view::MeshDraw& draw, view::FrameStats& stats);
    Result<void> prepare_displaced(const view::MeshDraw& draw, view::FrameStats& stats);
    Result<void> prepare_warps(const std::vector<view::MeshDraw>& draws,
                               const scene::Camera& camera, view::FrameStats& stats);

    std::map<std::pair<const scene::Mesh*, Look>, Triangles> triangles_;
    std::vector<Derived<ResidentMesh>> displaced_;
    std::vector<Derived<ResidentHull>> hulls_;
    TileResidency tiles_;
    std::map<const scene::MeshNode*, gl::Texture2D> warps_; // of the last frame
};

} // namespace reljef::render
