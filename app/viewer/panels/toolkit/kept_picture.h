#pragma once

#include <functional>
#include <vector>

#include <glm/vec2.hpp>

#include "app/viewer/panels/toolkit/pixel_area.h"
#include "engine/core/color.h"
#include "engine/gl/framebuffer.h"

namespace reljef::app {

/// A rounded rectangle of the window, pixels from the upper left corner.
struct RoundedArea {
    glm::ivec2 low{0};
    glm::ivec2 high{0};
    int radius = 0; ///< of the corners
};

/// Rectangles that together cover a rounded area once, within a window of that size.
std::vector<PixelArea> strips_of(const RoundedArea& area, glm::ivec2 window);

/// Keeps a picture of opaque panels, so that a frame copies it instead of drawing panels again.
/// Destroy while the context is current.
class KeptPicture {
public:
    /// Draws an area of the picture.
    using DrawArea = std::function<void(const PixelArea& area, Image& picture)>;

    /// Makes a picture of that size, with undefined content. Returns false if OpenGL cannot hold
    /// it.
    bool resize(glm::ivec2 window);
    /// Draws what changed into the picture, and copies the areas to the window's back buffer.
    void draw(const std::vector<RoundedArea>& areas, const std::vector<PixelArea>& changed,
              const DrawArea& draw_area);
    /// Copies the areas to the window's back buffer.
    void show() const;
    [[nodiscard]] bool is_of(glm::ivec2 window) const { return kept_.size() == window; }

private:
    Image drawn_;
    gl::Framebuffer kept_; // the same, first row on top
    std::vector<PixelArea> strips_;
};

} // namespace reljef::app
