#pragma once

#include <glm/vec4.hpp>

#include "engine/core/grid.h"
#include "engine/scene/graph/surface_detail.h"
#include "engine/scene/graph/texture_plane.h"

namespace reljef::render {

/// No warp of a mesh has more samples.
inline constexpr int max_warp_samples = 1 << 20;

/// Relief texture mapping by forward warping (prewarp.h) of a tile on a flat mesh: what each place
/// of the mesh shows to an eye (local metres, w as of Warp), spread evenly over its texture
/// coordinates from the lowest to the highest. Coordinate of the tile, its height there, and 1; all
/// 0 where nothing is seen. As many samples as texels, or as max_warp_samples. `lift`: metres that
/// a height of 1 lifts a point.
Grid<glm::vec4> warped_tile(const scene::TexturePlane& plane, const scene::SurfaceDetail& detail,
                            double lift, glm::dvec4 local_eye);

} // namespace reljef::render
