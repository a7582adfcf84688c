#pragma once

#include <functional>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/gl/framebuffer.h"

namespace reljef::app {

/// A rounded rectangle of the window, pixels from the upper left corner.
struct RoundedArea {
    glm::ivec2 low{0};
    glm::ivec2 high{0};
    int radius = 0; ///< of the corners
};

/// A rectangle, pixels.
struct PixelArea {
    glm::ivec2 low{0};
    glm::ivec2 size{0};

    friend bool operator==(const PixelArea&, const PixelArea&) = default;
};

/// Rectangles that together cover a rounded area once, within a window of that size.
std::vector<PixelArea> strips_of(const RoundedArea& area, glm::ivec2 window);

/// Keeps a picture of opaque panels, so that a frame copies it instead of drawing panels again:
/// software renderers copy in less time than they blend. Destroy while the context is current.
class KeptPicture {
public:
    /// Draws into the picture. Returns false, and draws nothing, if OpenGL cannot hold it.
    bool draw(glm::ivec2 window, std::vector<RoundedArea> areas,
              const std::function<void()>& draw_panels);
    /// Copies the areas to the window's back buffer.
    void show() const;
    [[nodiscard]] bool is_of(glm::ivec2 window) const { return target_.size() == window; }

private:
    gl::Framebuffer target_;
    std::vector<PixelArea> strips_; // from the lower left corner
};

} // namespace reljef::app
