#pragma once

#include "bench/report/results.h"
#include "engine/core/color.h"
#include "engine/core/hit.h"
#include "engine/core/result.h"
#include "engine/scene/graph/scene.h"
#include "engine/session/scene_renderer.h"

namespace reljef::bench {

struct DrawnPicture {
    Image colors;
    HitBuffer hits;
};

/// Draws the scene's view once, and its hits.
Result<DrawnPicture> draw_picture(const scene::Scene& scene, session::SceneRenderer& renderer);

/// Compares two pictures of a scene in perspective, whose hits are on a terrain in memory on a
/// plane. With `hits_round`, the tolerance of a hit with other bits is the error of rounding along
/// its ray (view::RayError).
RowSkip::Difference difference_of(const scene::Scene& scene, const scene::Node& terrain,
                                  const DrawnPicture& all, const DrawnPicture& without,
                                  bool hits_round);

} // namespace reljef::bench
