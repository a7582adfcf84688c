#pragma once

#include <glm/vec2.hpp>

#include "engine/core/color.h"
#include "engine/core/result.h"
#include "engine/gl/framebuffer.h"

namespace reljef::render {

/// Shows pictures that the CPU has drawn in the window of the current context. Destroy while the
/// context is current.
class WindowPicture {
public:
    /// Copies a picture to the window's back buffer; scales it if the sizes differ. Fails if GL
    /// cannot hold it.
    Result<void> show(const Image& picture, glm::ivec2 window_size);

private:
    gl::Framebuffer target_;
};

} // namespace reljef::render
