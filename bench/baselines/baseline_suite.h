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

/// What programs are compared at. Each has a row of reljef that the others are compared with.
enum class BaselineWork {
    levels,    ///< triangles, with levels or an error bound
    triangles, ///< a vertex for every sample
    relief,    ///< a flat square that shows heights
    hits,      ///< of rays, without a picture
    picture,   ///< by rays
};
std::string_view to_string(BaselineWork work);

struct BaselineRow {
    BaselineWork work = BaselineWork::levels;
    scene::Pose pose = scene::Pose::overview;
    std::string what;          ///< "irrlicht:lods=5", "polygons:error=1": to_string of a technique
    bool is_reference = false; ///< the others of its work are compared with it
    bool moving = false;       ///< whether the camera moves
    std::size_t frames = 0;
    Summary ms;
    std::size_t triangles = 0;                    ///< of the last frame; 0: not counted
    std::optional<truth::Distribution> error;     ///< reprojection, pixels; still cameras only
    std::optional<truth::Distribution> hit_error; ///< texels; still cameras only
    double wrong_percent = 0.0;                   ///< of the picture; still cameras only
};

struct BaselineResults {
    Environment environment = {};
    BaselineOptions options = {};
    int side = 0; ///< samples
    std::vector<BaselineRow> rows = {};
    std::vector<std::string> notes = {}; ///< what was left out, and why
    RunEnd end = {};
};

/// A table for each work and pose.
FigureTable figure_table(const BaselineResults& results);

/// Draws the same heights and colours, without light and sky, with other programs and with reljef,
/// frames interleaved, from the poses overview and low. What is not installed is left out.
/// - levels: Irrlicht's terrain node at 1, 3 and 5 levels and polygons, in two windows: with a
///   still camera, whose triangles are selected before timing; then with a camera that moves to its
///   right by 1/500 of the terrain's width per frame, for settings with levels or an error bound.
/// - triangles: OpenSceneGraph's terrain tile and polygons, a still camera.
/// - relief: Irrlicht's parallax material and `parallax`, a still camera.
/// - hits: Embree and `exact` by rays on the CPU, all threads, without a picture.
/// - picture: POV-Ray's height field and `exact` by rays on the CPU, all threads.
/// Errors are against the exact hits. They come from depth buffers, hits, and pictures that show
/// depths or samples.
BaselineResults run_baselines(const BaselineOptions& options, const std::stop_token& stop);

} // namespace reljef::bench
