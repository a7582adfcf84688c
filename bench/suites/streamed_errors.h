#pragma once

#include <functional>
#include <vector>

#include "engine/core/hit.h"
#include "engine/scene/graph/camera.h"
#include "engine/scene/graph/terrain_node.h"

namespace reljef::bench {

/// The heights of a square raster.
struct SampleHeights {
    int side = 0;                                       ///< samples, at least 2
    std::function<double(glm::ivec2 sample)> height_at; ///< metres
};

/// Reprojection errors of a terrain that may be streamed, pixels, against the bilinear surface of
/// all samples: of each pixel of terrain in every `step`-th row and column.
std::vector<double> streamed_errors(const scene::TerrainNode& terrain, const SampleHeights& heights,
                                    const scene::Camera& camera, const HitBuffer& hits, int step);

} // namespace reljef::bench
