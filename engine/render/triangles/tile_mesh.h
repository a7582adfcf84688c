#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/result.h"
#include "engine/gl/buffer.h"
#include "engine/render/triangles/resident_mesh.h"
#include "engine/view/frame_stats.h"
#include "engine/view/grid_mesh.h"
#include "engine/view/triangles/slivers.h"
#include "engine/view/triangles/tile_cut.h"

namespace reljef::render {

/// Triangles of a terrain's tile, or of its seams. Slivers are drawn apart.
struct TileMesh {
    ResidentMesh mesh; ///< without slivers
    view::Slivers slivers;
    ResidentMesh mild; ///< three vertices for each, without indices
    ResidentMesh narrow;
};

// All of these fail when GL has no memory.

/// A mesh without slivers.
Result<TileMesh> tile_mesh(const std::vector<view::GridVertex>& vertices,
                           const std::vector<std::uint16_t>& indices, view::FrameStats& stats);

/// One mesh for each part.
Result<std::vector<TileMesh>> tile_meshes(const view::CutMesh& cut, view::FrameStats& stats);

/// Draws these triangles as slivers and all others not.
Result<void> set_slivers(TileMesh& mesh, const view::SliverView::Triangles& all,
                         view::Slivers slivers, view::FrameStats& stats);

} // namespace reljef::render
