#include "engine/gl/read_pixels.h"

#include <algorithm>
#include <span>

#include <glad/gl.h>

namespace reljef::gl {

namespace {

void check_8_bits(const Texture2D& color) {
    check(color.format() == Format::rgba8_srgb || color.format() == Format::rgba8,
          "a picture is read from 8-bit colour only");
}

template <class T> void turn_upside_down(Grid<T>& grid) {
    for (int upper = 0, lower = grid.rows() - 1; upper < lower; ++upper, --lower) {
        std::ranges::swap_ranges(grid.row(upper), grid.row(lower));
    }
}

/// Texels as stored, row 0 at the top.
template <class T> Grid<T> read_texture(const Texture2D& texture, GLenum type) {
    Grid<T> grid(texture.size().x, texture.size().y);
    const std::span<T> samples = grid.samples();
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureImage(texture.id(), 0, GL_RGBA, type, static_cast<GLsizei>(samples.size_bytes()),
                      samples.data());
    turn_upside_down(grid);
    return grid;
}

// Of a rectangle whose first row is counted from the top.
glm::ivec2 lower_left(const Texture2D& color, glm::ivec2 first, glm::ivec2 size) {
    const glm::ivec2 end = first + size;
    check(first.x >= 0 && first.y >= 0 && end.x <= color.size().x && end.y <= color.size().y,
          "a rectangle inside the picture was expected");
    return {first.x, color.size().y - end.y};
}

} // namespace

Image read_color(const Framebuffer& framebuffer) {
    check_8_bits(framebuffer.color());
    return read_texture<Rgba8>(framebuffer.color(), GL_UNSIGNED_BYTE);
}

Image read_area(const Framebuffer& framebuffer, glm::ivec2 first, glm::ivec2 size) {
    const Texture2D& color = framebuffer.color();
    check_8_bits(color);
    const glm::ivec2 low = lower_left(color, first, size);
    Image colors(size.x, size.y);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureSubImage(color.id(), 0, low.x, low.y, 0, size.x, size.y, 1, GL_RGBA,
                         GL_UNSIGNED_BYTE, static_cast<GLsizei>(colors.samples().size_bytes()),
                         colors.samples().data());
    turn_upside_down(colors);
    return colors;
}

void write_area(Framebuffer& framebuffer, glm::ivec2 first, const Image& colors) {
    const Texture2D& color = framebuffer.color();
    check_8_bits(color);
    Image rows_up = colors;
    turn_upside_down(rows_up);
    const glm::ivec2 size(colors.cols(), colors.rows());
    const glm::ivec2 low = lower_left(color, first, size);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(color.id(), 0, low.x, low.y, size.x, size.y, GL_RGBA, GL_UNSIGNED_BYTE,
                        rows_up.samples().data());
}

Grid<glm::vec4> read_float_color(const Framebuffer& framebuffer) {
    return read_texture<glm::vec4>(framebuffer.color(), GL_FLOAT);
}

Grid<glm::vec4> read_second_color(const Framebuffer& framebuffer) {
    return read_texture<glm::vec4>(framebuffer.second_color(), GL_FLOAT);
}

} // namespace reljef::gl
