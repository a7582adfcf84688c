#pragma once

#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/grid.h"
#include "engine/view/draw_list.h"

namespace reljef::view {

/// A height on a bold contour line, which it interrupts. Pixels from the picture's upper left
/// corner.
struct ContourLabel {
    std::string text;           ///< metres
    glm::dvec2 middle{0.0};     ///< of the text
    glm::dvec2 along{1.0, 0.0}; ///< the reading direction, a unit vector towards the right
    double opacity = 1.0;       ///< (0, 1]
    double depth = 0.0;         ///< of the ground along the view axis, metres
    double depth_reach = 0.0;   ///< by which depths of the ground under the label differ, at most

    friend bool operator==(const ContourLabel&, const ContourLabel&) = default;
};

struct ContourLabels {
    double digit_height = 0.0; ///< pixels
    std::vector<ContourLabel> labels;
};

/// What makes contours visible.
struct ContourInk {
    double half_pixels = 0.0;     ///< between two lines that have half of their ink
    double bold_every = 0.0;      ///< lines from a bold one to the next bold one
    double height_rounding = 0.0; ///< of the height: level ground changes by less per pixel
};
/// At a contour_scale() of 1.
ContourInk contour_ink();

/// Labels of the bold contours that a list's picture shows: along straight parts of visible lines,
/// not too close to each other. The ground is searched in cells that are about equally large on the
/// picture, so a label stays at its place in the world until its cell is divided. Empty for
/// terrains without contours or without contour labels. `magnification`: how many times as large
/// the picture will be shown; its labels are smaller by as much. Precondition: the list's camera
/// shows no part of a picture.
ContourLabels contour_labels(const DrawList& list, double magnification = 1.0);

/// Whether something nearer than the ground covers a label's middle or an end: a mesh. Places
/// outside the picture count as free. `depths`: Hit::depth of its pixels.
bool is_covered(const ContourLabel& label, double digit_height, const Grid<float>& depths);

} // namespace reljef::view
