#include "engine/view/picture/picture_marks.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <glm/common.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vector_relational.hpp>

#include "engine/core/check.h"
#include "engine/view/picture/ink.h"
#include "engine/view/picture/label_strokes.h"
#include "engine/view/picture/scale_bar.h"

namespace reljef::view {
namespace {

// In heights of a digit.
constexpr double mark_margin = 1.7; // to the picture's border
constexpr double line_spacing = 2.3;
constexpr double legend_to_text = 0.75;
constexpr double north_radius = 2.1;
constexpr double north_to_letter = 1.1; // beyond the tip
constexpr double plate_margin = 0.7;    // around a mark
constexpr double plate_opacity = 0.5;

double line_radius_of(double digit_height) {
    return std::max(0.6, 0.07 * digit_height);
}

double text_width(const std::string& text, double digit_height) {
    return digit_height * text_strokes(text).width;
}

struct LegendLabel {
    double share = 0.0; // of the range of heights
    std::string text;
};

// Round heights, at least a line apart. The highest one has the unit.
std::vector<LegendLabel> legend_labels(const std::vector<LegendStop>& stops, double lines) {
    const double bottom = stops.front().height;
    const double range = stops.back().height - bottom;
    std::vector<LegendLabel> labels;
    if (!(range > 0.0)) {
        return labels;
    }
    const double step = round_step(range / lines);
    constexpr double rounding_share = 1e-6; // of a step
    const double first = std::ceil(bottom / step - rounding_share);
    for (int i = 0; (first + i) * step <= bottom + range + rounding_share * step; ++i) {
        const double height = (first + i) * step;
        labels.push_back({(height - bottom) / range, text_of_multiple(height, step)});
    }
    if (!labels.empty()) {
        labels.back().text += " m";
    }
    return labels;
}

Rgba8 legend_color(const std::vector<LegendStop>& stops, double share) {
    const double place = share * static_cast<double>(stops.size() - 1);
    const auto below =
        static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(stops.size() - 2)));
    const Rgba8 high = stops[below + 1].color;
    return blended(stops[below].color, glm::dvec3(high.r, high.g, high.b),
                   std::clamp(place - static_cast<double>(below), 0.0, 1.0));
}

// Pixels of the picture; `high` lies beyond.
struct LegendRamp {
    glm::ivec2 low;
    glm::ivec2 high;

    [[nodiscard]] double height_at(double share) const { return high.y - share * (high.y - low.y); }
};

void fill_ramp(const std::vector<LegendStop>& stops, const LegendRamp& ramp, GridView<Rgba8> part,
               glm::ivec2 first) {
    const glm::ivec2 size(part.cols(), part.rows());
    const glm::ivec2 low = glm::clamp(ramp.low - first, glm::ivec2(0), size);
    const glm::ivec2 high = glm::clamp(ramp.high - first, glm::ivec2(0), size);
    for (int row = low.y; row < high.y; ++row) {
        const double up = ramp.high.y - (row + first.y + 0.5);
        const Rgba8 color = legend_color(stops, up / (ramp.high.y - ramp.low.y));
        for (int col = low.x; col < high.x; ++col) {
            const std::uint8_t alpha = part(col, row).a;
            part(col, row) = {color.r, color.g, color.b, alpha};
        }
    }
}

// In pixels of the picture.
struct Plate {
    glm::dvec2 low;
    glm::dvec2 high;
};

scene::PicturePart pixels_of(const Plate& plate, glm::ivec2 size) {
    const glm::dvec2 whole(size);
    const glm::ivec2 low(glm::clamp(glm::floor(plate.low), glm::dvec2(0.0), whole));
    const glm::ivec2 high(glm::clamp(glm::ceil(plate.high), glm::dvec2(0.0), whole));
    return {low, high - low};
}

bool contains(const scene::PicturePart& plate, glm::ivec2 pixel) {
    return glm::all(glm::greaterThanEqual(pixel, plate.first)) &&
           glm::all(glm::lessThan(pixel, plate.first + plate.size));
}

// Once where they meet, as in small pictures.
void fill_plates(const std::vector<scene::PicturePart>& plates, GridView<Rgba8> part,
                 glm::ivec2 first) {
    const glm::ivec2 size(part.cols(), part.rows());
    for (auto plate = plates.begin(); plate != plates.end(); ++plate) {
        const glm::ivec2 low = glm::clamp(plate->first - first, glm::ivec2(0), size);
        const glm::ivec2 high = glm::clamp(plate->first + plate->size - first, glm::ivec2(0), size);
        for (int row = low.y; row < high.y; ++row) {
            for (int col = low.x; col < high.x; ++col) {
                const glm::ivec2 pixel = first + glm::ivec2(col, row);
                if (std::none_of(plates.begin(), plate, [&](const scene::PicturePart& other) {
                        return contains(other, pixel);
                    })) {
                    part(col, row) = blended(part(col, row), paper_color, plate_opacity);
                }
            }
        }
    }
}

struct LegendPlan {
    std::vector<LegendLabel> labels;
    LegendRamp ramp;
    Plate plate;
};

LegendPlan plan_legend(const std::vector<LegendStop>& stops, glm::ivec2 size) {
    constexpr double max_share = 0.42; // of the picture's height
    constexpr double max_height = 17.0;
    constexpr double width = 1.2;
    const double digits = mark_digit_height(size);
    const double height = std::min(max_share * size.y, max_height * digits);
    LegendPlan plan;
    plan.labels = legend_labels(stops, height / (line_spacing * digits));
    double text = 0.0;
    for (const LegendLabel& label : plan.labels) {
        text = std::max(text, text_width(label.text, digits));
    }
    const glm::dvec2 corner(size.x - (mark_margin + legend_to_text) * digits - text,
                            size.y - (mark_margin + 0.5) * digits);
    plan.ramp = {glm::ivec2(glm::round(corner - glm::dvec2(width * digits, height))),
                 glm::ivec2(glm::round(corner))};
    const double right = size.x - mark_margin * digits;
    const glm::dvec2 around = glm::dvec2(plate_margin, plate_margin + 0.5) * digits; // half a label
    plan.plate = {glm::dvec2(plan.ramp.low) - around, glm::dvec2(right, plan.ramp.high.y) + around};
    return plan;
}

void draw_legend_mark(const std::vector<LegendStop>& stops, glm::ivec2 size, GridView<Rgba8> part,
                      glm::ivec2 first) {
    constexpr double tick = 0.4;
    const double digits = mark_digit_height(size);
    const LegendPlan plan = plan_legend(stops, size);
    const LegendRamp& ramp = plan.ramp;
    const double line = line_radius_of(digits);
    const glm::dvec2 low = glm::dvec2(ramp.low) - line;
    const glm::dvec2 high = glm::dvec2(ramp.high) + line;
    InkDrawing ink(digits);
    ink.add_line({low, {high.x, low.y}, high, {low.x, high.y}, low}, line);
    for (const LegendLabel& label : plan.labels) {
        const double y = ramp.height_at(label.share);
        ink.add_line({{high.x, y}, {high.x + tick * digits, y}}, line);
        ink.add_text(label.text, {ramp.high.x + legend_to_text * digits, y});
    }
    ink.draw(part, first);
    fill_ramp(stops, ramp, part, first);
}

// A place of the picture.
void add_target(InkDrawing& ink, glm::dvec2 middle, double digits) {
    constexpr double ring = 0.36;
    constexpr double cross_begin = 0.14;
    constexpr double cross_end = 0.72;
    const double line = line_radius_of(digits);
    ink.add_circle(middle, ring * digits, line);
    for (const glm::dvec2 way : {glm::dvec2(1.0, 0.0), glm::dvec2(-1.0, 0.0), glm::dvec2(0.0, 1.0),
                                 glm::dvec2(0.0, -1.0)}) {
        ink.add_line({middle + cross_begin * digits * way, middle + cross_end * digits * way},
                     line);
    }
}

struct ScalePlan {
    ScaleBar bar;
    std::string text;
    glm::dvec2 begin{0.0};  // of the bar
    glm::dvec2 left{0.0};   // of the text, at the middle of its digits
    glm::dvec2 target{0.0}; // of the mark behind the text, if there is one
    Plate plate;
};

ScalePlan plan_scale(const PictureMarks::Scale& scale, glm::ivec2 size) {
    constexpr double text_above = 1.25;
    constexpr double gap = 1.35;
    constexpr double target_reach = 0.8;
    const double digits = mark_digit_height(size);
    ScalePlan plan;
    plan.bar = scale_bar(scale.metres_per_pixel, max_scale_bar(size));
    plan.text = bar_text(plan.bar.metres) + (scale.is_everywhere ? "" : " at");
    plan.begin = begin_of_scale_bar(size);
    plan.left = plan.begin - glm::dvec2(0.0, text_above * digits);
    plan.target = plan.left + glm::dvec2(text_width(plan.text, digits) + gap * digits, 0.0);
    const double text_end = scale.is_everywhere ? plan.left.x + text_width(plan.text, digits)
                                                : plan.target.x + target_reach * digits;
    const double right = std::max(plan.begin.x + plan.bar.pixels, text_end);
    plan.plate = {plan.left - glm::dvec2(plate_margin, 0.5 + plate_margin) * digits,
                  glm::dvec2(right, plan.begin.y) + plate_margin * digits};
    return plan;
}

void draw_scale_mark(const PictureMarks::Scale& scale, glm::ivec2 size, GridView<Rgba8> part,
                     glm::ivec2 first) {
    constexpr double tick = 0.5;
    const double digits = mark_digit_height(size);
    const ScalePlan plan = plan_scale(scale, size);
    const glm::dvec2 end = plan.begin + glm::dvec2(plan.bar.pixels, 0.0);
    const glm::dvec2 up(0.0, -tick * digits);
    const double line = 1.5 * line_radius_of(digits);
    InkDrawing ink(digits);
    ink.add_line({plan.begin + up, plan.begin, end, end + up}, line);
    ink.add_text(plan.text, plan.left);
    if (!scale.is_everywhere) {
        add_target(ink, plan.target, digits);
        add_target(ink, 0.5 * glm::dvec2(size), digits);
    }
    ink.draw(part, first);
}

// The arrow and its letter turn within it.
Plate north_plate(glm::ivec2 size) {
    const double digits = mark_digit_height(size);
    const glm::dvec2 corner(size.x - mark_margin * digits, mark_margin * digits);
    const double side = (2.0 * (north_radius + north_to_letter) + 1.0) * digits;
    return {corner + glm::dvec2(-side, 0.0) + glm::dvec2(-plate_margin, -plate_margin) * digits,
            corner + glm::dvec2(0.0, side) + plate_margin * digits};
}

void draw_north_mark(double north, glm::ivec2 size, GridView<Rgba8> part, glm::ivec2 first) {
    constexpr double radius = north_radius;
    const double digits = mark_digit_height(size);
    const double reach = (mark_margin + radius + north_to_letter + 0.5) * digits;
    const glm::dvec2 middle(size.x - reach, reach);
    const double angle = glm::radians(north);
    const glm::dvec2 ahead(std::sin(angle), -std::cos(angle));
    const glm::dvec2 right(-ahead.y, ahead.x);
    const auto at = [&](double along, double across) {
        return middle + digits * (along * ahead + across * right);
    };
    const glm::dvec2 tip = at(radius, 0.0);
    const glm::dvec2 notch = at(-1.0, 0.0);
    const glm::dvec2 left_corner = at(-1.7, -1.05);
    const glm::dvec2 right_corner = at(-1.7, 1.05);
    InkDrawing ink(digits);
    ink.add_area({tip, notch, left_corner});
    ink.add_line({tip, right_corner, notch, left_corner, tip, notch}, line_radius_of(digits));
    const std::string letter = "N";
    ink.add_text(letter, at(radius + north_to_letter, 0.0) -
                             glm::dvec2(0.5 * text_width(letter, digits), 0.0));
    ink.draw(part, first);
}

} // namespace

double mark_digit_height(glm::ivec2 size) {
    constexpr double usual_height = 12.0;
    constexpr double min_height = 8.0;
    constexpr glm::dvec2 usual_size(1024.0, 768.0);
    const glm::dvec2 share = glm::dvec2(size) / usual_size;
    return std::max(min_height, usual_height * std::min(share.x, share.y));
}

glm::dvec2 begin_of_scale_bar(glm::ivec2 size) {
    const double margin = mark_margin * mark_digit_height(size);
    return glm::floor(glm::dvec2(margin, size.y - margin)) + 0.5;
}

double max_scale_bar(glm::ivec2 size) {
    constexpr double share = 0.22;
    return share * size.x;
}

std::vector<scene::PicturePart> mark_plates(const PictureMarks& marks, glm::ivec2 size) {
    std::vector<scene::PicturePart> plates;
    if (marks.legend.size() >= 2) {
        plates.push_back(pixels_of(plan_legend(marks.legend, size).plate, size));
    }
    if (marks.scale) {
        plates.push_back(pixels_of(plan_scale(*marks.scale, size).plate, size));
    }
    if (marks.north) {
        plates.push_back(pixels_of(north_plate(size), size));
    }
    return plates;
}

void draw_marks(const PictureMarks& marks, glm::ivec2 size, GridView<Rgba8> part,
                glm::ivec2 first) {
    check(size.x >= min_marked_picture.x && size.y >= min_marked_picture.y,
          "a picture with room for marks was expected");
    fill_plates(mark_plates(marks, size), part, first);
    if (marks.legend.size() >= 2) {
        draw_legend_mark(marks.legend, size, part, first);
    }
    if (marks.scale) {
        draw_scale_mark(*marks.scale, size, part, first);
    }
    if (marks.north) {
        draw_north_mark(*marks.north, size, part, first);
    }
}

} // namespace reljef::view
