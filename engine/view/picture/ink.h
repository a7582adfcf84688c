#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/color.h"
#include "engine/core/grid.h"

namespace reljef::view {

// Dark lines with a pale border are legible on any picture. All lengths are pixels.

inline constexpr glm::dvec3 ink_color{38.0, 31.0, 25.0}; ///< encoded
inline constexpr glm::dvec3 paper_color{246.0, 243.0, 235.0};
inline constexpr double paper_opacity = 0.8;

/// Half the width of the lines of text whose digits are this high.
double pen_radius(double digit_height);
/// By how much the pale border is wider, on each side.
double border_width(double digit_height);

double distance_to_segment(glm::dvec2 place, glm::dvec2 from, glm::dvec2 to);

/// Share of a pixel that a line of half width `radius` covers.
double coverage(double distance, double radius);

Rgba8 blended(Rgba8 color, glm::dvec3 over, double opacity);

/// Lines, areas and texts over a picture, within one border.
class InkDrawing {
public:
    explicit InkDrawing(double digit_height) : digit_height_(digit_height) {}

    void add_line(const std::vector<glm::dvec2>& points, double radius);
    void add_circle(glm::dvec2 middle, double radius, double line_radius);
    /// `corners`: of a convex area, clockwise on the picture (y is down).
    void add_area(std::vector<glm::dvec2> corners) { areas_.push_back(std::move(corners)); }
    /// `left`: of its first character, at the middle of the digits. As text_strokes().
    void add_text(std::string_view text, glm::dvec2 left);

    /// `first`: pixel of the picture at part(0, 0). The pixels do not depend on the parts.
    void draw(GridView<Rgba8> part, glm::ivec2 first) const;

private:
    struct Segment {
        glm::dvec2 from;
        glm::dvec2 to;
        double radius;
    };
    class Distances;

    double digit_height_;
    std::vector<Segment> segments_;
    std::vector<std::vector<glm::dvec2>> areas_;
};

} // namespace reljef::view
