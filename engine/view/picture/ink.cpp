#include "engine/view/picture/ink.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/view/picture/label_strokes.h"

namespace reljef::view {
namespace {

// Half widths, in heights of a digit and in pixels.
constexpr double pen = 0.068;
constexpr double min_pen = 0.6;
constexpr double border = 0.24;

// Negative inside of a convex area.
double distance_to_area(glm::dvec2 place, const std::vector<glm::dvec2>& corners) {
    double distance = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec2 along = corners[(i + 1) % corners.size()] - corners[i];
        const glm::dvec2 outwards = glm::normalize(glm::dvec2(along.y, -along.x));
        distance = std::max(distance, glm::dot(place - corners[i], outwards));
    }
    return distance;
}

struct PixelBox {
    glm::dvec2 low{std::numeric_limits<double>::infinity()};
    glm::dvec2 high{-std::numeric_limits<double>::infinity()};

    void add(glm::dvec2 place, double radius) {
        low = glm::min(low, place - radius);
        high = glm::max(high, place + radius);
    }
};

} // namespace

double pen_radius(double digit_height) {
    return std::max(pen * digit_height, min_pen);
}

double border_width(double digit_height) {
    return border * digit_height;
}

double distance_to_segment(glm::dvec2 place, glm::dvec2 from, glm::dvec2 to) {
    const glm::dvec2 along = to - from;
    const double length_squared = glm::dot(along, along);
    const double share = length_squared > 0.0
                             ? std::clamp(glm::dot(place - from, along) / length_squared, 0.0, 1.0)
                             : 0.0;
    return glm::distance(place, from + share * along);
}

double coverage(double distance, double radius) {
    return std::clamp(0.5 + radius - distance, 0.0, 1.0);
}

Rgba8 blended(Rgba8 color, glm::dvec3 over, double opacity) {
    const auto channel = [opacity](std::uint8_t below, double above) {
        return static_cast<std::uint8_t>(std::lround(glm::mix(double(below), above, opacity)));
    };
    return {channel(color.r, over.x), channel(color.g, over.y), channel(color.b, over.z), color.a};
}

void InkDrawing::add_line(const std::vector<glm::dvec2>& points, double radius) {
    for (std::size_t i = 1; i < points.size(); ++i) {
        segments_.push_back({points[i - 1], points[i], radius});
    }
}

void InkDrawing::add_circle(glm::dvec2 middle, double radius, double line_radius) {
    constexpr int sides = 24;
    std::vector<glm::dvec2> points;
    for (int i = 0; i <= sides; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / sides;
        points.push_back(middle + radius * glm::dvec2(std::cos(angle), std::sin(angle)));
    }
    add_line(points, line_radius);
}

void InkDrawing::add_text(std::string_view text, glm::dvec2 left) {
    for (const CharacterStrokes& character : text_strokes(text).characters) {
        for (std::vector<glm::dvec2> line : character.lines) {
            for (glm::dvec2& point : line) {
                point = left + digit_height_ * point;
            }
            add_line(line, pen_radius(digit_height_));
        }
    }
}

// To the edge of the nearest ink, of the pixels that the drawing changes in a part of a picture.
class InkDrawing::Distances {
public:
    Distances(const InkDrawing& drawing, glm::ivec2 first, glm::ivec2 size)
        : reach_(border_width(drawing.digit_height_) + 1.0), part_(first), part_size_(size) {
        PixelBox box;
        for (const Segment& segment : drawing.segments_) {
            box.add(segment.from, segment.radius);
            box.add(segment.to, segment.radius);
        }
        for (const auto& corners : drawing.areas_) {
            for (const glm::dvec2 corner : corners) {
                box.add(corner, 0.0);
            }
        }
        const Area area = area_of(box, part_, part_ + part_size_);
        first_ = area.low;
        distances_ =
            Grid<float>(area.size().x, area.size().y, std::numeric_limits<float>::infinity());
        for (const Segment& segment : drawing.segments_) {
            add(segment);
        }
        for (const auto& corners : drawing.areas_) {
            add(corners);
        }
    }

    // `use(pixel of the part, distance)`
    template <class Use> void for_each(const Use& use) const {
        for (int row = 0; row < distances_.rows(); ++row) {
            for (int col = 0; col < distances_.cols(); ++col) {
                use(glm::ivec2(col, row) + first_ - part_,
                    static_cast<double>(distances_(col, row)));
            }
        }
    }

private:
    struct Area {
        glm::ivec2 low;
        glm::ivec2 high;
        [[nodiscard]] glm::ivec2 size() const { return glm::max(high - low, glm::ivec2(0)); }
    };

    // The pixels that ink in a box and its border may change, within others.
    [[nodiscard]] Area area_of(const PixelBox& box, glm::ivec2 low, glm::ivec2 high) const {
        const auto within = [&](glm::dvec2 place) {
            return glm::ivec2(glm::clamp(place, glm::dvec2(low), glm::dvec2(high)));
        };
        return {within(glm::floor(box.low - reach_)), within(glm::ceil(box.high + reach_))};
    }

    template <class Distance> void add(const PixelBox& box, const Distance& distance_at) {
        const glm::ivec2 size(distances_.cols(), distances_.rows());
        const Area area = area_of(box, first_, first_ + size);
        for (int row = area.low.y; row < area.high.y; ++row) {
            for (int col = area.low.x; col < area.high.x; ++col) {
                float& nearest = distances_(col - first_.x, row - first_.y);
                const double distance = distance_at(glm::dvec2(col, row) + 0.5);
                nearest = std::min(nearest, static_cast<float>(distance));
            }
        }
    }

    void add(const Segment& segment) {
        PixelBox box;
        box.add(segment.from, segment.radius);
        box.add(segment.to, segment.radius);
        add(box, [&](glm::dvec2 place) {
            return distance_to_segment(place, segment.from, segment.to) - segment.radius;
        });
    }

    void add(const std::vector<glm::dvec2>& corners) {
        PixelBox box;
        for (const glm::dvec2 corner : corners) {
            box.add(corner, 0.0);
        }
        add(box, [&](glm::dvec2 place) { return distance_to_area(place, corners); });
    }

    double reach_;
    glm::ivec2 part_;
    glm::ivec2 part_size_;
    glm::ivec2 first_{0};
    Grid<float> distances_;
};

void InkDrawing::draw(GridView<Rgba8> part, glm::ivec2 first) const {
    const Distances distances(*this, first, {part.cols(), part.rows()});
    const double width = border_width(digit_height_);
    distances.for_each([&](glm::ivec2 pixel, double distance) {
        Rgba8& color = part(pixel.x, pixel.y);
        color = blended(color, paper_color, paper_opacity * coverage(distance, width));
        color = blended(color, ink_color, coverage(distance, 0.0));
    });
}

} // namespace reljef::view
