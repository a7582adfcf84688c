#pragma once

#include <glm/vec2.hpp>

namespace reljef::app {

/// A rectangle of pixels; its low corner is the upper left one.
struct PixelArea {
    glm::ivec2 low{0};
    glm::ivec2 size{0};

    [[nodiscard]] bool is_empty() const { return size.x <= 0 || size.y <= 0; }
    friend bool operator==(const PixelArea&, const PixelArea&) = default;
};

} // namespace reljef::app
