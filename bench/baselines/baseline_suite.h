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
    std::string terrain = "natural"; ///< its middle 2^n+1 × 2^n+1 samples are drawn
};

struct BaselineRow {
    scene::Pose pose = scene::Pose::overview;
    std::string what;    ///< "irrlicht:lods=5", "polygons:error=1": to_string of a technique
    bool moving = false; ///< whether the camera moves
    std::size_t frames = 0;
    Summary ms;
    std::size_t triangles = 0;                ///< of the last frame
    std::optional<truth::Distribution> error; ///< reprojection, pixels; still cameras only
};

/// The other rows are compared with this technique.
inline constexpr scene::Technique reference_technique{scene::Polygons{.error = 1.0}};

struct BaselineResults {
    Environment environment = {};
    BaselineOptions options = {};
    int side = 0; ///< samples
    std::vector<BaselineRow> rows = {};
    RunEnd end = {};
};

FigureTable figure_table(const BaselineResults& results);

/// Draws the same heights and colours, without light and sky, with Irrlicht's terrain node at 1, 3
/// and 5 levels and with polygons, in two windows, frames interleaved: with a still camera, whose
/// triangles are selected before timing; then with a camera that moves to its right by 1/500 of the
/// terrain's width per frame, for settings with levels or an error bound. Irrlicht's error comes
/// from its depth buffer. Fails if the build found no Irrlicht.
BaselineResults run_baselines(const BaselineOptions& options, const std::stop_token& stop);

} // namespace reljef::bench
