#pragma once

#include <optional>
#include <string>

#include <glm/vec2.hpp>

#include "engine/session/scene_setup.h"

namespace reljef::session {

/// Contours that are too close to each other on a picture to be drawn.
struct FadedContours {
    bool shows_bold = false;     ///< every fifth line is far enough from the next one
    double shown_interval = 0.0; ///< metres, round: such contours are drawn on most of the ground
    /// Metres from the eye: nearer, most are drawn. Absent without perspective.
    std::optional<double> shown_distance;
};

/// Whether contours have less than half of their ink on most of the sloping ground that a picture
/// of `size` pixels from the scene's camera shows. Empty if they have not, and where none are
/// drawn. A streamed terrain has the slopes of its overview.
std::optional<FadedContours> faded_contours(const TerrainScene& scene, glm::ivec2 size);

/// One sentence on faded contours of an interval, metres.
std::string faded_text(const FadedContours& faded, double interval);

} // namespace reljef::session
