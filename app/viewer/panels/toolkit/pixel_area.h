#pragma once

#include <vector>

#include <glm/vec2.hpp>

namespace reljef::app {

/// A rectangle of pixels; its low corner is the upper left one.
struct PixelArea {
    glm::ivec2 low{0};
    glm::ivec2 size{0};

    [[nodiscard]] glm::ivec2 high() const { return low + size; }
    [[nodiscard]] bool is_empty() const { return size.x <= 0 || size.y <= 0; }
    friend bool operator==(const PixelArea&, const PixelArea&) = default;
};

/// Joins rectangles that overlap to one that contains both, until none do.
std::vector<PixelArea> disjoint(std::vector<PixelArea> areas);

} // namespace reljef::app
