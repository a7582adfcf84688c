#include "engine/view/picture/label_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/view/picture/ink.h"
#include "engine/view/picture/label_strokes.h"

namespace reljef::view {
namespace {

// Pixels from the text's middle to where its border ends, along it and across.
glm::dvec2 reach(const TextStrokes& text, double digit_height) {
    const double around = pen_radius(digit_height) + border_width(digit_height) + 1.0;
    return 0.5 * digit_height * glm::dvec2(text.width, 1.0) + around;
}

// All in heights of a digit. Infinite where no character is nearer than `max`.
double distance_to_text(const TextStrokes& text, glm::dvec2 place, double max) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const CharacterStrokes& character : text.characters) {
        if (place.x < character.begin - max || place.x > character.end + max) {
            continue;
        }
        for (const auto& line : character.lines) {
            for (std::size_t i = 1; i < line.size(); ++i) {
                nearest = std::min(nearest, distance_to_segment(place, line[i - 1], line[i]));
            }
        }
    }
    return nearest;
}

} // namespace

scene::PicturePart label_area(const ContourLabel& label, double digit_height, glm::ivec2 size) {
    const glm::dvec2 half = reach(text_strokes(label.text), digit_height);
    const glm::dvec2 along = glm::abs(label.along);
    const glm::dvec2 box(along.x * half.x + along.y * half.y, along.y * half.x + along.x * half.y);
    const auto on_picture = [size](glm::dvec2 place) {
        return glm::ivec2(glm::clamp(place, glm::dvec2(0.0), glm::dvec2(size)));
    };
    const glm::ivec2 first = on_picture(glm::floor(label.middle - box));
    return {first, on_picture(glm::ceil(label.middle + box)) - first};
}

void draw_label(const ContourLabel& label, double digit_height, GridView<Rgba8> part,
                glm::ivec2 first) {
    const TextStrokes text = text_strokes(label.text);
    const glm::dvec2 half = reach(text, digit_height);
    const glm::dvec2 down(-label.along.y, label.along.x);
    const double radius = pen_radius(digit_height);
    const double border_radius = radius + border_width(digit_height);
    for (int row = 0; row < part.rows(); ++row) {
        for (int col = 0; col < part.cols(); ++col) {
            const glm::dvec2 from_middle =
                glm::dvec2(first) + glm::dvec2(col, row) + 0.5 - label.middle;
            const glm::dvec2 on_text(glm::dot(from_middle, label.along),
                                     glm::dot(from_middle, down));
            if (std::abs(on_text.x) > half.x || std::abs(on_text.y) > half.y) {
                continue;
            }
            const glm::dvec2 place = on_text / digit_height + glm::dvec2(0.5 * text.width, 0.0);
            const double distance =
                digit_height * distance_to_text(text, place, (border_radius + 1.0) / digit_height);
            Rgba8& color = part(col, row);
            color = blended(color, paper_color,
                            paper_opacity * label.opacity * coverage(distance, border_radius));
            color = blended(color, ink_color, label.opacity * coverage(distance, radius));
        }
    }
}

} // namespace reljef::view
