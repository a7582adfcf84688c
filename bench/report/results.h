#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "bench/report/row_view.h"
#include "engine/core/parallel_for.h"
#include "engine/core/result.h"
#include "engine/core/statistics.h"
#include "engine/platform/context.h"
#include "engine/scene/motion/poses.h"
#include "engine/scene/technique/technique.h"
#include "engine/truth/geometric_error.h"
#include "engine/view/frame_stats.h"

namespace reljef::bench {

/// Where a run was measured. Times of different environments are not comparable.
struct Environment {
    std::string renderer = {}; ///< GL_RENDERER
    std::string gl = {};       ///< GL_VERSION
    std::string context = {};  ///< "osmesa", "egl", "glfw"
    unsigned threads = 1;      ///< of a software renderer
    std::string cpu = {};      ///< model name, or "unknown"
    std::string commit = {};   ///< of the configured sources; "unknown" without git
    std::string costs = {};    ///< that `auto` chooses by, see session::costs_text; empty: unknown

    /// Whether a graphics card drew.
    [[nodiscard]] bool has_gpu() const;

    friend bool operator==(const Environment&, const Environment&) = default;
};

/// A part of a run, and where it was measured.
struct PartOrigin {
    Shard shard;
    Environment environment;
};

/// `threads`: 0 takes LP_NUM_THREADS, which limits llvmpipe, or else all of the machine.
Environment environment_of(const platform::RendererInfo& info, int threads);

/// Rows with a larger noise floor are noisy.
inline constexpr double max_noise = 0.10;

/// Fewer frames give neither a noise floor nor an interval, see median_interval().
inline constexpr std::size_t min_frames = 5;

/// A technique with its parameters, as text.
struct Setting {
    struct Parameter {
        std::string name;
        double value = 0.0;
        friend bool operator==(const Parameter&, const Parameter&) = default;
    };

    std::string technique; ///< "polygons"
    std::vector<Parameter> parameters;
    std::string label; ///< "polygons:lods=1"
};
Setting setting_of(const scene::Technique& technique);

struct Timing {
    std::size_t frames = 0; ///< at least 1
    Summary ms;             ///< from the first command of a frame to its completion
    /// Of the median, ms; see median_interval(). Absent with fewer than min_frames.
    std::optional<ConfidenceInterval> interval;
    double fps_1_percent_low = 0.0; ///< of the slowest hundredth of the frames
    /// Of the medians in the same run; absent if texture shows no terrain.
    std::optional<double> ratio_to_texture;
    /// Distance of the medians of the null row and its original, a share of the smaller median;
    /// absent if either has fewer than min_frames.
    std::optional<double> noise_floor;
    std::optional<double> gpu_ms; ///< median; absent on software renderers
    view::FrameStats stats;       ///< of the last frame
};

/// The times of frames, in ms, and their noise floor; without a ratio and stats. Precondition:
/// some.
Timing timed(const std::vector<double>& ms, std::optional<double> noise_floor);

/// Errors of a picture, see engine/truth/geometric_error.h and image_error.h.
struct RowError {
    struct Geometric {
        truth::Distribution distribution;
        std::size_t unbounded = 0; ///< pixels with an infinite error
    };

    std::optional<Geometric> reprojection_px; ///< absent if no pixel has a finite error
    std::optional<Geometric> hit_texels;      ///< likewise
    double wrong_percent = 0.0;               ///< of all pixels
    /// Of the pixels that show terrain in the picture or in the true one; absent in old results.
    std::optional<double> wrong_of_terrain_percent = {};
    std::size_t holes = 0; ///< pixels
    double rmse = 0.0;
    std::optional<double> psnr; ///< dB; absent for identical pictures
    std::optional<double> ssim; ///< absent if the picture is smaller than the SSIM window
    double flip = 0.0;          ///< mean
};

/// A measurement of the sources (suites/source_tests.h).
struct SourceFigure {
    double fps = 0.0;
    double ratio = 1.0; ///< frame time over that of texture in the same test
    std::string where;  ///< "relief-4, configuration 2"
};

/// What a row of the suite skip leaves on, and what that saves. Savings are the difference from the
/// row that skips everything; absent if they are not known.
struct RowSkip {
    struct Savings {
        std::optional<double> ms; ///< of the medians
        std::optional<double> taps;
        std::optional<double> steps;
        std::optional<double> rays;
        double triangles = 0.0;
        double bytes_uploaded = 0.0;
        std::optional<double> bytes_read;
        double state_changes = 0.0;
    };
    /// The pictures and hits with and without it. Hits differ where floats round differently.
    struct Difference {
        std::size_t pixels = 0; ///< with another colour
        int levels = 0;         ///< largest difference of a channel, of 255
        std::size_t hits = 0;   ///< with other bits
        std::size_t edges = 0;  ///< of these, those that show sky instead of terrain, or reversed
        /// How far such a hit is from its pixel, and how far it may be by rounding: of the hit that
        /// is the farthest for its tolerance. A tolerance of 0: hits must have the same bits.
        double max_px = 0.0;
        double tolerance_px = 0.0;
        int tolerance_levels = 0; ///< for `levels`, where hits have the same bits

        [[nodiscard]] bool is_same() const { return pixels == 0 && hits == 0; }
        [[nodiscard]] bool is_allowed() const {
            return hits == 0 ? levels <= tolerance_levels
                             : tolerance_px > 0.0 && max_px <= tolerance_px;
        }
    };

    std::string without;              ///< the kind of skipping that is off; empty: none
    std::string meaning;              ///< what it skips
    std::optional<double> bytes_read; ///< of files, for the tiles of this picture
    Difference difference;
    Savings saved; ///< by the kind
};

/// What a row of the suite objects draws, and from where.
struct RowObjects {
    std::string form;          ///< building::city_form_names
    std::size_t buildings = 0; ///< of the city
    double distance = 0.0;     ///< of the eye from the middle, metres
    double down = 0.0;         ///< degrees that it looks down
    std::size_t bytes = 0;     ///< sent to the GPU to draw the first frame, which it keeps
};

struct Row {
    std::string suite;
    std::string test;  ///< of the sources, "relief-4"; may be empty
    std::string scene; ///< any bytes, because it may come from a file name
    scene::Pose pose = scene::Pose::overview;
    Setting setting;
    /// Repeats texture, or the first technique that shows terrain, for the noise floor (A/A).
    bool null_row = false;
    glm::ivec2 size{0}; ///< of the picture, pixels
    Timing timing;
    std::optional<RowError> error;
    std::optional<SourceFigure> source;
    std::optional<view::WorkTotals> work; ///< of terrains; absent if it was not counted
    std::optional<RowSkip> skip;          ///< of the suite skip
    std::optional<RowObjects> objects;    ///< of the suite objects, whose views are no pose
    std::shared_ptr<const RowView> view;  ///< only with SuiteOptions::keep_views; not in the JSON

    /// Taps per pixel.
    [[nodiscard]] std::optional<double> taps() const;
    [[nodiscard]] bool has_few_frames() const { return timing.frames < min_frames; }
    /// Whether the noise floor is above max_noise, or unknown because of too few frames.
    [[nodiscard]] bool noisy() const;
    /// Whether the picture shows no terrain.
    [[nodiscard]] bool shows_nothing() const { return error && !error->reprojection_px; }
};

/// The Pareto front of one scene and pose, see pareto_front.h.
struct Front {
    struct Dominated {
        std::string label;
        std::string by; ///< a label of the front
    };

    std::string scene;
    scene::Pose pose = scene::Pose::overview;
    /// [0,1], smaller is better; absent if a technique was left out or texture shows no terrain.
    std::optional<double> area;
    std::vector<std::string> front; ///< labels, the fastest first
    std::vector<Dominated> dominated;
    std::vector<std::string> holed; ///< labels of rows with too many holes
};

/// Settings of one scene and pose without a row, because time ran out or the run was stopped.
struct LeftOut {
    std::string scene;
    scene::Pose pose = scene::Pose::overview;
    std::size_t settings = 0;            ///< their number
    std::vector<std::string> techniques; ///< those whose default was left out
};

/// What the options of a suite said. Sizes and techniques are in the rows.
struct RunSettings {
    bool quick = false;
    int rounds = 0; ///< 0: as many as fit
    bool moving = false;
    bool cold = false;
};

struct Results {
    Environment environment;
    std::optional<RunSettings> settings = {}; ///< absent: of an earlier version
    Shard shard = {};                         ///< the part of the run's scenes and poses
    std::vector<Row> rows;
    std::vector<Front> fronts; ///< of the suite pareto
    std::vector<LeftOut> left_out;
    std::vector<std::string> notes; ///< shown below the tables
    std::optional<Error> stopped;   ///< why the run ended early
    bool failed = false;            ///< it ended early by an error, not by request

    /// Whether all requested rows exist.
    [[nodiscard]] bool complete() const { return !stopped && left_out.empty(); }
};

} // namespace reljef::bench
