#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/result.h"
#include "engine/gl/buffer.h"
#include "engine/render/residency/resident_mesh.h"
#include "engine/view/frame_stats.h"
#include "engine/view/grid_mesh.h"
#include "engine/view/triangles/tile_cut.h"

namespace reljef::render {

/// Triangles of a terrain's tile, or of its seams. Slivers (view::SliverView) are drawn apart.
struct TileMesh {
    ResidentMesh mesh;                  ///< without slivers
    std::vector<std::uint32_t> slivers; ///< numbers of triangles, ascending
    gl::Buffer sliver_corners;          ///< vertices, three for each
};

/// Triangles in the memory of the CPU.
struct TileTriangles {
    std::span<const view::GridVertex> vertices;
    std::span<const std::uint16_t> indices;
};

// All of these fail when GL has no memory.

/// A mesh without slivers.
Result<TileMesh> tile_mesh(const std::vector<view::GridVertex>& vertices,
                           const std::vector<std::uint16_t>& indices, view::FrameStats& stats);

/// One mesh for each part.
Result<std::vector<TileMesh>> tile_meshes(const view::CutMesh& cut, view::FrameStats& stats);

/// Draws these triangles as slivers and all others not. `indices`: of all triangles of the mesh.
Result<void> set_slivers(TileMesh& mesh, std::span<const std::uint16_t> indices,
                         std::vector<std::uint32_t> slivers, view::FrameStats& stats);

} // namespace reljef::render
