#pragma once

#include <glm/vec4.hpp>

#include "engine/core/grid.h"
#include "engine/scene/graph/mesh.h"
#include "engine/scene/graph/surface_detail.h"

namespace reljef::render {

inline constexpr int max_warp_samples = 1 << 20;

/// Forward warping (prewarp.h) of a relief tile on a flat mesh. The samples cover the mesh's
/// texture coordinates evenly, one per texel up to max_warp_samples. Each holds the visible tile
/// coordinate, its height and 1, or zeros. `lift`: height of 1, metres. `local_eye`: metres, w as
/// for Warp.
Grid<glm::vec4> warped_tile(const scene::TexturePlane& plane, const scene::SurfaceDetail& detail,
                            double lift, glm::dvec4 local_eye);

} // namespace reljef::render
