#pragma once

#include "engine/core/result.h"
#include "engine/render/triangles/mesh_group.h"
#include "engine/view/frame_stats.h"

namespace reljef::render {

/// Cuts the tiles of a coarse terrain that need other triangles, as coarsely as their number is
/// limited. Fails when GL has no memory.
Result<void> cut_meshes(const DrawnGroup& drawn, Bisections& bisections, view::FrameStats& stats);

} // namespace reljef::render
