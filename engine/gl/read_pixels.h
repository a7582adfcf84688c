#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "engine/core/color.h"
#include "engine/core/grid.h"
#include "engine/gl/framebuffer.h"

namespace reljef::gl {

/// The colour as stored (sRGB-encoded for rgba8_srgb), row 0 at the top. Waits for the GPU.
/// Precondition: rgba8_srgb or rgba8.
Image read_color(const Framebuffer& framebuffer);

/// The same of a rectangle: its first column, and its first row from the top. Precondition: as
/// read_color(); the rectangle lies inside.
Image read_area(const Framebuffer& framebuffer, glm::ivec2 first, glm::ivec2 size);
/// Replaces the colours of a rectangle. Preconditions: as read_area().
void write_area(Framebuffer& framebuffer, glm::ivec2 first, const Image& colors);

/// The colour as floats, row 0 at the top. Missing channels are 0, missing alpha is 1; bytes map to
/// [0,1] as stored. Waits for the GPU.
Grid<glm::vec4> read_float_color(const Framebuffer& framebuffer);
/// The same of the second colour.
Grid<glm::vec4> read_second_color(const Framebuffer& framebuffer);

} // namespace reljef::gl
