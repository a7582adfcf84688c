#include "engine/render/window_picture.h"

namespace reljef::render {

Result<void> WindowPicture::show(const Image& picture, glm::ivec2 window_size) {
    const glm::ivec2 size(picture.cols(), picture.rows());
    if (target_.size() != size) {
        auto made =
            gl::Framebuffer::create({.size = size, .color = gl::Format::window8, .depth = false});
        if (!made) {
            return made.error();
        }
        target_ = std::move(*made);
    }
    target_.upload(picture);
    target_.blit_to_window(window_size, gl::FirstRow::top);
    return {};
}

} // namespace reljef::render
