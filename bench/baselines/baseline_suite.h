#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "bench/report/figure_table.h"
#include "bench/runner/suite_options.h"
#include "engine/scene/motion/poses.h"
#include "engine/scene/technique/technique.h"
#include "engine/truth/geometric_error.h"

namespace reljef::bench {

struct BaselineOptions {
    SuiteOptions suite;
    std::string terrain = "natural"; ///< of which the middle 2^n+1 × 2^n+1 samples are drawn
};

/// One way to draw the terrain from one pose.
struct BaselineRow {
    scene::Pose pose = scene::Pose::overview;
    std::string what;    ///< "irrlicht:lods=5", "polygons:error=1": to_string of a technique
    bool moving = false; ///< the camera, from frame to frame; triangles are those of the last one
    std::size_t frames = 0;
    Summary ms;
    std::size_t triangles = 0;
    std::optional<truth::Distribution> error; ///< reprojection, pixels; of still cameras
};

/// The technique that the others are compared with.
inline constexpr scene::Technique reference_technique{scene::Polygons{.error = 1.0}};

struct BaselineResults {
    Environment environment;
    BaselineOptions options;
    int side = 0; ///< samples
    std::vector<BaselineRow> rows;
    RunEnd end;
};

FigureTable figure_table(const BaselineResults& results);

/// Draws the terrain with Irrlicht's terrain node at 1, 3 and 5 levels and with polygons, frames in
/// turns, each in a window of its own: with a still camera, whose triangles are chosen before
/// they are timed, and those that choose by distance or error also with one that moves a 500th of
/// the terrain's width to its right each frame. Both show the same heights and colours, without
/// light and sky. Irrlicht's error is that of the places its depth buffer names. Fails, saying how
/// to get it, where the build found no Irrlicht.
BaselineResults run_baselines(const BaselineOptions& options, const std::stop_token& stop);

} // namespace reljef::bench
