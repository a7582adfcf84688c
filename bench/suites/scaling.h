#pragma once

#include <cstddef>
#include <filesystem>
#include <stop_token>
#include <vector>

#include "bench/report/figure_table.h"
#include "bench/runner/suite_options.h"
#include "engine/scene/motion/poses.h"

namespace reljef::bench {

struct ScalingOptions {
    SuiteOptions suite;
    std::vector<int> sides{1024, 4096, 16384}; ///< samples, each >= 2
    int memory_megabytes = 512;                ///< memory budget
    double error = 1.0;                        ///< error bound, pixels
    std::filesystem::path folder;              ///< for temporary rasters; empty: the system's
};

struct ScalingRow {
    int side = 0; ///< samples
    scene::Pose pose = scene::Pose::overview;
    bool streamed = false;    ///< terrain exceeds the memory budget
    double first_picture = 0; ///< seconds from opening the context and the file
    double last_picture = 0;  ///< the same, at full resolution
    std::size_t frames = 0;
    Summary ms; ///< of a frame with a still camera
    int tiles = 0;
    std::size_t triangles = 0;
    std::size_t memory_bytes = 0; ///< peak of the process since the raster was opened
    std::size_t pixels = 0;       ///< checked: terrain in every fourth row and column
    double worst_px = 0.0;        ///< reprojection error
    double p99_px = 0.0;
};

struct ScalingResults {
    Environment environment = {};
    ScalingOptions options = {};
    std::vector<ScalingRow> rows = {};
    RunEnd end = {};
};

/// Targets for the highest resolution, from the worst pose.
inline constexpr double max_frame_ratio = 1.3;   // to the lowest resolution
inline constexpr double max_first_picture = 2.0; // seconds

/// Shows the targets once the lowest and the highest resolution are measured.
FigureTable figure_table(const ScalingResults& results);

/// Writes the same 40 km of terrain at growing resolutions to a temporary folder and views each
/// from overview and low: the first picture as in `view`, the last as in `render`.
ScalingResults run_scaling(const ScalingOptions& options, const std::stop_token& stop);

} // namespace reljef::bench
