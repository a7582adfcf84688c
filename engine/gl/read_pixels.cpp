#include "engine/gl/read_pixels.h"

#include <algorithm>
#include <span>

#include <glad/gl.h>

namespace reljef::gl {

namespace {

/// Texels as stored, row 0 at the top.
template <class T> Grid<T> read_texture(const Texture2D& texture, GLenum type) {
    Grid<T> grid(texture.size().x, texture.size().y);
    const std::span<T> samples = grid.samples();
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureImage(texture.id(), 0, GL_RGBA, type, static_cast<GLsizei>(samples.size_bytes()),
                      samples.data());
    for (int upper = 0, lower = grid.rows() - 1; upper < lower; ++upper, --lower) {
        std::ranges::swap_ranges(grid.row(upper), grid.row(lower));
    }
    return grid;
}

} // namespace

Image read_color(const Framebuffer& framebuffer) {
    const Texture2D& color = framebuffer.color();
    check(color.format() == Format::rgba8_srgb || color.format() == Format::rgba8,
          "a picture is read from 8-bit colour only");
    return read_texture<Rgba8>(color, GL_UNSIGNED_BYTE);
}

Grid<glm::vec4> read_float_color(const Framebuffer& framebuffer) {
    return read_texture<glm::vec4>(framebuffer.color(), GL_FLOAT);
}

Grid<glm::vec4> read_second_color(const Framebuffer& framebuffer) {
    return read_texture<glm::vec4>(framebuffer.second_color(), GL_FLOAT);
}

} // namespace reljef::gl
