#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "bench/environment.h"
#include "bench/row_view.h"
#include "engine/core/result.h"
#include "engine/core/statistics.h"
#include "engine/render/frame_stats.h"
#include "engine/scene/poses.h"
#include "engine/scene/technique.h"
#include "engine/truth/geometric_error.h"

namespace reljef::bench {

/// A row above this noise floor is marked noisy: what it says of small differences is worth
/// nothing.
inline constexpr double most_noise = 0.10;

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
    std::size_t frames = 0;         ///< timed, at least 1
    Summary ms;                     ///< from the first command of a frame until all of it is drawn
    ConfidenceInterval interval;    ///< of the median, milliseconds, see median_interval()
    double fps_1_percent_low = 0.0; ///< 1000 over the mean of the slowest hundredth, milliseconds
    double ratio_to_texture = 1.0;  ///< of the medians, in the same run
    /// How far the medians of texture and its null row lie apart, a share of the smaller; absent
    /// where the run ended before there was a null row.
    std::optional<double> noise_floor;
    render::FrameStats stats; ///< of the last frame
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
    bool null_row = false;        ///< texture once more, only for the noise floor (A/A)
    glm::ivec2 size{0};           ///< of the picture, pixels
    std::optional<Timing> timing; ///< absent: the technique does not exist yet, the row is missing
    std::optional<RowError> error;
    std::optional<SourceFigure> source;
    std::shared_ptr<const RowView> view; ///< where it was asked for; not part of the JSON

    [[nodiscard]] bool missing() const { return !timing.has_value(); }
    /// Whether its noise floor is above most_noise.
    [[nodiscard]] bool noisy() const;
};

/// Which settings of one scene and pose are worth their time, see pareto_front.h.
struct Front {
    struct Dominated {
        std::string label;
        std::string by; ///< a label of the front
    };

    std::string scene;
    scene::Pose pose = scene::Pose::overview;
    double area = 1.0;              ///< [0,1], the smaller the better
    std::vector<std::string> front; ///< labels, the fastest first
    std::vector<Dominated> dominated;
};

/// What a run brought.
struct Results {
    Environment environment;
    std::vector<Row> rows;
    std::vector<Front> fronts;      ///< of the suite pareto
    std::vector<std::string> notes; ///< what a reader of the tables should be told; not in JSON
    std::optional<Error> stopped;   ///< why there are not all rows
};

} // namespace reljef::bench
