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

/// Pixels that show sky, but whose exact rays, and those `reach` pixels around them, hit the
/// terrain. A terrain's silhouette may have moved by less. Fails as streamed_errors(), and on a
/// terrain that is not streamed.
Result<std::size_t> streamed_holes(const scene::Scene& scene, const HitBuffer& hits, int reach,
                                   const ParallelOptions& parallel = {});

} // namespace reljef::bench
