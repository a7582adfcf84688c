#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <vector>

#include <glm/vec2.hpp>

#include "bench/report/environment.h"
#include "bench/runner/suite_options.h"
#include "engine/core/result.h"
#include "engine/core/statistics.h"
#include "engine/scene/motion/poses.h"

namespace reljef::bench {

struct GrowthOptions {
    SuiteOptions suite;
    std::vector<int> sides{1024, 4096, 16384}; ///< samples, each >= 2
    int memory_megabytes = 512;                ///< as --memory
    double error = 1.0;                        ///< as --max-error, pixels
    std::filesystem::path folder; ///< for the rasters meanwhile; empty: the system's for such files
};

/// One view of the same ground by so many samples.
struct GrowthRow {
    int side = 0; ///< samples
    scene::Pose pose = scene::Pose::overview;
    bool streamed = false;    ///< tile by tile, as not all of it fits the memory
    double first_picture = 0; ///< seconds from opening the context and the file until it is drawn
    double last_picture = 0;  ///< the same until nothing finer is to come for this view
    std::size_t frames = 0;
    Summary ms;    ///< of a frame with a still camera
    int tiles = 0; ///< drawn
    std::size_t triangles = 0;
    std::size_t memory_bytes = 0; ///< most of the process since the raster was opened
    std::size_t pixels = 0;       ///< judged: those of every fourth row and column on the terrain
    double worst_px = 0.0;        ///< of their reprojection errors, see truth/geometric_error.h
    double p99_px = 0.0;
};

struct GrowthResults {
    Environment environment;
    GrowthOptions options;
    std::vector<GrowthRow> rows;
    std::optional<Error> stopped; ///< why the run ended early
    bool failed = false;          ///< so it did by an error, and not as it was asked to
};

/// What the rows are measured by: a view of the most samples over the same of the fewest.
struct GrowthMarks {
    double frame_ratio = 0.0;     ///< the worst of the poses' medians
    double first_picture = 0.0;   ///< seconds, of the most samples
    std::size_t memory_bytes = 0; ///< likewise
};
inline constexpr double max_frame_ratio = 1.3;
inline constexpr double max_first_picture = 2.0; // seconds
/// Absent where the fewest or the most samples were not measured.
std::optional<GrowthMarks> marks_of(const GrowthResults& results);

/// Which of them are no more than they may be.
struct MetMarks {
    bool frame_ratio = false;
    bool first_picture = false;
    bool memory = false; ///< --memory
};
MetMarks met_marks(const GrowthMarks& marks, const GrowthOptions& options);

/// Writes the same square of ground as GeoTIFFs of growing resolution, tiled and with overviews, to
/// a folder of its own that is removed in the end, and looks at each from the poses overview and
/// low as the program does: `view` for the first picture, `render` for the last.
GrowthResults run_growth(const GrowthOptions& options, const std::stop_token& stop);

} // namespace reljef::bench
