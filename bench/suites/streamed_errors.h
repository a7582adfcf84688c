#pragma once

#include <vector>

#include "engine/core/hit.h"
#include "engine/core/parallel_for.h"
#include "engine/core/result.h"
#include "engine/scene/graph/scene.h"

namespace reljef::bench {

/// Reprojection errors of a scene's terrain, pixels, against the bilinear surface of all samples,
/// also of those that are streamed: of each pixel of terrain in every `step`-th row and column.
/// Fails when the scene has not exactly one terrain, and if a tile cannot be read.
Result<std::vector<double>> streamed_errors(const scene::Scene& scene, const HitBuffer& hits,
                                            int step, const ParallelOptions& parallel = {});

} // namespace reljef::bench
