#include "engine/gl/read_pixels.h"

#include <algorithm>
#include <span>

#include <glad/gl.h>

namespace reljef::gl {

namespace {

template <class T> void flip(Grid<T>& grid) {
    for (int upper = 0, lower = grid.rows() - 1; upper < lower; ++upper, --lower) {
        std::ranges::swap_ranges(grid.row(upper), grid.row(lower));
    }
}

/// Texels as stored (no sRGB decoding), row 0 at the top.
template <class T> Grid<T> read_texture(const Texture2D& texture, GLenum layout, GLenum type) {
    Grid<T> grid(texture.size().x, texture.size().y);
    const std::span<T> samples = grid.samples();
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureImage(texture.id(), 0, layout, type, static_cast<GLsizei>(samples.size_bytes()),
                      samples.data());
    flip(grid);
    return grid;
}

} // namespace

Image read_color(const Framebuffer& framebuffer, std::size_t index) {
    const Texture2D& color = framebuffer.color(index);
    check(color.format() == Format::rgba8_srgb || color.format() == Format::rgba8,
          "a picture is read from 8-bit colour only");
    return read_texture<Rgba8>(color, GL_RGBA, GL_UNSIGNED_BYTE);
}

Grid<glm::vec4> read_float_color(const Framebuffer& framebuffer, std::size_t index) {
    return read_texture<glm::vec4>(framebuffer.color(index), GL_RGBA, GL_FLOAT);
}

Grid<float> read_depth(const Framebuffer& framebuffer) {
    return read_texture<float>(framebuffer.depth(), GL_DEPTH_COMPONENT, GL_FLOAT);
}

} // namespace reljef::gl
