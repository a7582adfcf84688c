#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "bench/report/environment.h"
#include "bench/report/row_view.h"
#include "engine/core/result.h"
#include "engine/core/statistics.h"
#include "engine/scene/motion/poses.h"
#include "engine/scene/technique/technique.h"
#include "engine/truth/geometric_error.h"
#include "engine/view/frame_stats.h"

namespace reljef::bench {

/// A row above this noise floor is marked noisy: what it says of small differences is worth
/// nothing.
inline constexpr double max_noise = 0.10;

/// Of fewer frames neither a noise floor nor an interval can be told, see median_interval().
inline constexpr std::size_t min_frames = 5;

/// A technique by its names, which the program that reads them need not know.
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

/// How fast.
struct Timing {
    std::size_t frames = 0; ///< timed, at least 1
    Summary ms;             ///< from the first command of a frame until all of it is drawn
    /// Of the median, milliseconds, see median_interval(); absent under min_frames.
    std::optional<ConfidenceInterval> interval;
    double fps_1_percent_low = 0.0; ///< 1000 over the mean of the slowest hundredth, milliseconds
    /// Of the medians, in the same run; absent where texture shows no terrain, as its time says
    /// nothing then.
    std::optional<double> ratio_to_texture;
    /// How far the medians of a null row and of what it is once more lie apart, a share of the
    /// smaller; absent where either has under min_frames.
    std::optional<double> noise_floor;
    std::optional<double> gpu_ms; ///< median of what the GPU took; absent on software renderers
    view::FrameStats stats;       ///< of the last frame
};

/// How wrong: engine/truth/geometric_error.h and image_error.h say what is what.
struct RowError {
    struct Geometric {
        truth::Distribution distribution;
        std::size_t unbounded = 0; ///< pixels whose error is infinite
    };

    std::optional<Geometric> reprojection_px; ///< absent where no pixel has a finite one
    std::optional<Geometric> hit_texels;      ///< likewise
    double wrong_percent = 0.0;               ///< of all pixels
    std::size_t holes = 0;                    ///< pixels
    double rmse = 0.0;
    std::optional<double> psnr; ///< dB; absent where the pictures are identical
    std::optional<double> ssim; ///< absent where the picture is smaller than its window
    double flip = 0.0;          ///< mean
};

/// What a source measured itself.
struct SourceFigure {
    double fps = 0.0;
    double ratio = 1.0; ///< its frame time over that of texture in the same test
    std::string where;  ///< "relief-4, configuration 2"
};

/// One technique on one scene.
struct Row {
    std::string suite;
    std::string test;  ///< of the sources, "relief-4"; empty where it is none of theirs
    std::string scene; ///< UTF-8 or whatever bytes a file's name has
    scene::Pose pose = scene::Pose::overview;
    Setting setting;
    /// Only for the noise floor (A/A): texture once more, or where it shows no terrain the first
    /// technique that does.
    bool null_row = false;
    glm::ivec2 size{0};           ///< of the picture, pixels
    std::optional<Timing> timing; ///< absent: the technique does not exist yet, the row is missing
    std::optional<RowError> error;
    std::optional<SourceFigure> source;
    std::shared_ptr<const RowView> view; ///< where it was asked for; not part of the JSON

    [[nodiscard]] bool missing() const { return !timing.has_value(); }
    [[nodiscard]] bool has_few_frames() const; ///< timed ones, under min_frames
    /// Whether its noise floor is above max_noise, or it has too few frames for one.
    [[nodiscard]] bool noisy() const;
    /// Whether it was held against the truth and shows none of the terrain.
    [[nodiscard]] bool shows_nothing() const;
};

/// Which settings of one scene and pose are worth their time, see pareto_front.h.
struct Front {
    struct Dominated {
        std::string label;
        std::string by; ///< a label of the front
    };

    std::string scene;
    scene::Pose pose = scene::Pose::overview;
    /// [0,1], the smaller the better; absent where it would not be that of all techniques, as the
    /// default of one was left out, or texture, its measure, shows no terrain.
    std::optional<double> area;
    std::vector<std::string> front; ///< labels, the fastest first
    std::vector<Dominated> dominated;
    std::vector<std::string> holed; ///< labels of the rows that have too many holes for a place
};

/// Settings of one scene and pose that are no rows, for want of time or as the run was stopped.
struct LeftOut {
    std::string scene;
    scene::Pose pose = scene::Pose::overview;
    std::size_t settings = 0;            ///< so many
    std::vector<std::string> techniques; ///< whose first setting, the default, is one of them
};

/// What a run brought.
struct Results {
    Environment environment;
    std::vector<Row> rows;
    std::vector<Front> fronts; ///< of the suite pareto
    std::vector<LeftOut> left_out;
    std::vector<std::string> notes; ///< what a reader of the tables should be told
    std::optional<Error> stopped;   ///< why the run ended early
    bool failed = false;            ///< so it did by an error, and not as it was asked to

    /// Whether there is every row that was asked for.
    [[nodiscard]] bool complete() const { return !stopped && left_out.empty(); }
};

} // namespace reljef::bench
