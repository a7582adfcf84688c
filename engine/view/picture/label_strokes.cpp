#include "engine/view/picture/label_strokes.h"

#include <array>
#include <cmath>
#include <numbers>

namespace reljef::view {
namespace {

using Line = std::vector<glm::dvec2>;

constexpr double digit_width = 0.56;
constexpr double gap = 0.17; // between characters

struct Ellipse {
    glm::dvec2 middle;
    glm::dvec2 radii;
};

// Counter-clockwise from +x, degrees. y goes up, from the foot of the digit.
Line arc(const Ellipse& ellipse, double from, double to) {
    constexpr double step = 22.5;
    const int steps = static_cast<int>(std::ceil(std::abs(to - from) / step));
    Line line;
    for (int i = 0; i <= steps; ++i) {
        const double angle = (from + (to - from) * i / steps) * std::numbers::pi / 180.0;
        line.push_back(ellipse.middle +
                       ellipse.radii * glm::dvec2(std::cos(angle), std::sin(angle)));
    }
    return line;
}

Line operator+(Line line, const Line& rest) {
    line.insert(line.end(), rest.begin(), rest.end());
    return line;
}

std::vector<Line> six() {
    return {arc({{0.52, 0.32}, {0.48, 0.68}}, 98.0, 180.0) +
            arc({{0.28, 0.30}, {0.24, 0.30}}, 180.0, 540.0)};
}

std::vector<Line> turned_around(std::vector<Line> lines) {
    for (Line& line : lines) {
        for (glm::dvec2& point : line) {
            point = glm::dvec2(digit_width, 1.0) - point;
        }
    }
    return lines;
}

std::vector<Line> lines_of_digit(int digit) {
    switch (digit) {
    case 0:
        return {arc({{0.28, 0.5}, {0.24, 0.5}}, 0.0, 360.0)};
    case 1:
        return {{{0.10, 0.80}, {0.32, 1.0}, {0.32, 0.0}}};
    case 2:
        return {arc({{0.28, 0.73}, {0.23, 0.27}}, 165.0, -30.0) + Line{{0.05, 0.0}, {0.52, 0.0}}};
    case 3:
        return {arc({{0.27, 0.755}, {0.21, 0.245}}, 150.0, -80.0),
                arc({{0.26, 0.265}, {0.25, 0.265}}, 90.0, -150.0)};
    case 4:
        return {{{0.54, 0.28}, {0.03, 0.28}, {0.41, 1.0}, {0.41, 0.0}}};
    case 5:
        return {Line{{0.47, 1.0}, {0.12, 1.0}, {0.09, 0.53}} +
                arc({{0.27, 0.32}, {0.25, 0.32}}, 120.0, -150.0)};
    case 6:
        return six();
    case 7:
        return {{{0.04, 1.0}, {0.52, 1.0}, {0.20, 0.0}}};
    case 8:
        return {arc({{0.28, 0.76}, {0.20, 0.24}}, -90.0, 270.0),
                arc({{0.28, 0.26}, {0.24, 0.26}}, 90.0, 450.0)};
    default:
        return turned_around(six());
    }
}

struct Character {
    std::vector<Line> lines; // y up, from the foot
    double width = 0.0;
};

constexpr double x_height = 0.7; // of small letters

Character small_m() {
    constexpr glm::dvec2 radii(0.19, 0.24);
    const auto arch = [&](double left) {
        const Ellipse bow{{left + radii.x, x_height - radii.y}, radii};
        return arc(bow, 180.0, 0.0) + Line{{left + 2.0 * radii.x, 0.0}};
    };
    constexpr double stem = 0.05;
    return {{{{stem, x_height}, {stem, 0.0}}, arch(stem), arch(stem + 2.0 * radii.x)},
            2.0 * stem + 4.0 * radii.x};
}

Character character_of(char letter) {
    switch (letter) {
    case '-':
        return {{{{0.02, 0.46}, {0.40, 0.46}}}, 0.42};
    case '.':
        return {{{{0.05, 0.0}, {0.05, 0.01}}}, 0.10};
    case ' ':
        return {{}, 0.16};
    case 'N':
        return {{{{0.05, 0.0}, {0.05, 1.0}, {0.57, 0.0}, {0.57, 1.0}}}, 0.62};
    case 'a':
        return {{arc({{0.26, 0.5 * x_height}, {0.21, 0.5 * x_height}}, 0.0, 360.0),
                 {{0.47, x_height}, {0.47, 0.0}}},
                0.52};
    case 'k':
        return {{{{0.05, 1.0}, {0.05, 0.0}},
                 {{0.43, x_height}, {0.05, 0.28}},
                 {{0.19, 0.42}, {0.46, 0.0}}},
                0.50};
    case 'm':
        return small_m();
    case 't':
        return {{Line{{0.15, 0.95}, {0.15, 0.18}} + arc({{0.33, 0.18}, {0.18, 0.18}}, 180.0, 270.0),
                 {{0.01, x_height}, {0.33, x_height}}},
                0.36};
    default:
        return letter >= '0' && letter <= '9' ? Character{lines_of_digit(letter - '0'), digit_width}
                                              : Character{};
    }
}

} // namespace

TextStrokes text_strokes(std::string_view text) {
    TextStrokes strokes;
    double x = 0.0;
    for (const char letter : text) {
        Character character = character_of(letter);
        if (character.width <= 0.0) {
            continue;
        }
        for (Line& line : character.lines) {
            for (glm::dvec2& point : line) {
                point = {x + point.x, 0.5 - point.y};
            }
        }
        strokes.characters.push_back({std::move(character.lines), x, x + character.width});
        strokes.width = x + character.width;
        x = strokes.width + gap;
    }
    return strokes;
}

} // namespace reljef::view
