#pragma once

#include "engine/core/result.h"
#include "engine/render/triangles/mesh_group.h"
#include "engine/view/frame_stats.h"

namespace reljef::render {

/// Joins the tiles of a stream with those that are drawn beside them. Fails when GL has no memory.
/// Precondition: all tiles have their triangles.
Result<void> seam_meshes(const DrawnGroup& drawn, view::FrameStats& stats);

} // namespace reljef::render
