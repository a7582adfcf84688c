#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <vector>

#include "bench/report/figure_table.h"
#include "bench/runner/suite_options.h"
#include "engine/scene/motion/poses.h"

namespace reljef::bench {

struct ScalingOptions {
    SuiteOptions suite;
    std::vector<int> sides{1024, 4096, 16384}; ///< samples, each >= 2
    int memory_megabytes = 512;                ///< as --memory
    double error = 1.0;                        ///< as --max-error, pixels
    std::filesystem::path folder;              ///< of the temporary rasters; empty: the system's
};

/// One view of the terrain at one resolution.
struct ScalingRow {
    int side = 0; ///< samples
    scene::Pose pose = scene::Pose::overview;
    bool streamed = false;    ///< larger than the memory budget
    double first_picture = 0; ///< seconds from opening the context and the file
    double last_picture = 0;  ///< the same, until the view has its final resolution
    std::size_t frames = 0;
    Summary ms; ///< of a frame with a still camera
    int tiles = 0;
    std::size_t triangles = 0;
    std::size_t memory_bytes = 0; ///< peak of the process since the raster was opened
    std::size_t pixels = 0;       ///< judged: every fourth row and column that shows terrain
    double worst_px = 0.0;        ///< reprojection error, see truth/geometric_error.h
    double p99_px = 0.0;
};

struct ScalingResults {
    Environment environment;
    ScalingOptions options;
    std::vector<ScalingRow> rows;
    RunEnd end;
};

/// Targets: the highest resolution compared with the lowest, the worst pose.
inline constexpr double max_frame_ratio = 1.3;
inline constexpr double max_first_picture = 2.0; // seconds

/// With the targets below the table once the lowest and the highest resolution are measured.
FigureTable figure_table(const ScalingResults& results);

/// Writes the same 40 km of terrain as GeoTIFFs of growing resolution, tiled and with overviews, to
/// a temporary folder, and views each from the poses overview and low as the program does: `view`
/// for the first picture, `render` for the last.
ScalingResults run_scaling(const ScalingOptions& options, const std::stop_token& stop);

} // namespace reljef::bench
