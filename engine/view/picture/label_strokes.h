#pragma once

#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

namespace reljef::view {

/// A character as a line of points. The unit is the height of a digit; x goes right from the left
/// end of the text, y down from the middle of its digits.
struct CharacterStrokes {
    std::vector<std::vector<glm::dvec2>> lines;
    double begin = 0.0; ///< x of its place in the text
    double end = 0.0;
};

struct TextStrokes {
    std::vector<CharacterStrokes> characters;
    double width = 0.0;
};

/// Of digits, minus, point, space, and the letters of "N", "m", "km" and "at"; other characters are
/// left out.
TextStrokes text_strokes(std::string_view text);

} // namespace reljef::view
