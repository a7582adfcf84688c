#pragma once

#include <array>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/view/picture/label_ground.h"
#include "engine/view/picture/label_view.h"

namespace reljef::view {

/// A short piece of a contour on the picture.
struct ContourLine {
    static constexpr int steps = 4; ///< from the middle to each end
    static constexpr int middle = steps;

    std::array<glm::dvec2, 2 * steps + 1> pixels{};
    std::array<glm::dvec3, 2 * steps + 1> places{}; ///< world metres
    /// Pixels by which the middle moves on the picture per metre that it climbs.
    glm::dvec2 climb{0.0};
    double depth = 0.0;       ///< of the middle along the view axis, metres
    double depth_reach = 0.0; ///< by which the depths of the line and of its sides differ
};

struct ContourPlace {
    glm::dvec2 sample{0.0}; ///< near the contour
    double height = 0.0;    ///< of the contour, true metres
    double step = 1.0;      ///< samples over which the ground is taken as flat
    double min_climb = 0.0; ///< length of ContourLine::climb
    double side = 0.0;      ///< pixels to each side of the line in which the ground rises evenly
};

/// Follows the contour to both sides for `half_length` pixels each. Empty if it leaves the terrain,
/// climbs less on the picture, is not even at its sides, or is behind the eye.
std::optional<ContourLine> follow_contour(const LabelGround& ground, const LabelView& view,
                                          const ContourPlace& place, double half_length);

} // namespace reljef::view
