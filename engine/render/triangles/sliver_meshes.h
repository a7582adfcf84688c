#pragma once

#include "engine/core/result.h"
#include "engine/render/triangles/mesh_group.h"
#include "engine/view/frame_stats.h"

namespace reljef::render {

/// Takes the slivers of this view out of the tiles' meshes, to be drawn apart. Fails when GL has no
/// memory. Preconditions: the tiles are cut by an error bound, and seamed.
Result<void> sliver_meshes(const DrawnGroup& drawn, Bisections& bisections,
                           view::FrameStats& stats);

} // namespace reljef::render
