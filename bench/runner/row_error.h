#pragma once

#include <optional>
#include <stop_token>

#include "bench/report/results.h"
#include "bench/runner/benchmark_scene.h"
#include "engine/session/scene_renderer.h"

namespace reljef::bench {

/// How wrong a technique's picture is, and what it looks like.
struct Judgement {
    RowError error;
    std::optional<ShownView> view; ///< where it was asked for
};

struct JudgeOptions {
    unsigned threads = 0; ///< 0: as many as the machine has
    bool keep_view = false;
    std::stop_token stop;
};

/// Draws a frame with a technique, from the pose set last, and holds it against the truth; the
/// stage keeps the technique. Not for timed rounds. A technique that shows no terrain where there
/// is some, as the flat surface from below, has holes and no reprojection error. Fails where the
/// driver or the truth does, and where there is not a single pixel of terrain in either picture:
/// that is no error of 0.
Result<Judgement> judge(BenchmarkScene& scene, const scene::Technique& technique,
                        session::SceneRenderer& driver, const JudgeOptions& options = {});

} // namespace reljef::bench
