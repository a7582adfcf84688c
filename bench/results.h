#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "bench/environment.h"
#include "engine/core/result.h"
#include "engine/core/statistics.h"
#include "engine/render/frame_stats.h"
#include "engine/scene/poses.h"
#include "engine/scene/technique.h"

namespace reljef::bench {

/// One technique on one scene.
struct Row {
    std::string suite;
    std::string scene;
    scene::Pose pose = scene::Pose::overview;
    scene::Technique technique;
    bool null_row = false; ///< texture once more, only for the noise floor (A/A)
    glm::ivec2 size{0};    ///< of the picture, pixels
    std::size_t frames = 0;
    Summary ms;                    ///< from the first command of a frame until all of it is drawn
    double ratio_to_texture = 1.0; ///< of the medians, in the same run
    /// How far the medians of texture and its null row lie apart, a share of the smaller; absent
    /// where the run ended before there was a null row.
    std::optional<double> noise_floor;
    render::FrameStats stats; ///< of the last frame
};

/// What a run brought.
struct Results {
    Environment environment;
    std::vector<Row> rows;
    std::optional<Error> stopped; ///< why there are not all rows
};

} // namespace reljef::bench
