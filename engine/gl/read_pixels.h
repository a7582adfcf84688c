#pragma once

#include <cstddef>

#include <glm/vec4.hpp>

#include "engine/core/color.h"
#include "engine/core/grid.h"
#include "engine/gl/framebuffer.h"

namespace reljef::gl {

/// The picture, row 0 at the top; bytes as stored (so sRGB-encoded for rgba8_srgb). Waits for the
/// GPU. Precondition: the colour is rgba8_srgb or rgba8.
Image read_color(const Framebuffer& framebuffer, std::size_t index = 0);

/// Four floats a pixel, row 0 at the top; channels that the format lacks are 0, alpha 1. Bytes give
/// [0,1] as stored. Waits for the GPU. Precondition: the colour exists.
Grid<glm::vec4> read_float_color(const Framebuffer& framebuffer, std::size_t index = 0);

/// The depth buffer's values in [0,1], row 0 at the top. Waits for the GPU. Precondition: it has a
/// depth.
Grid<float> read_depth(const Framebuffer& framebuffer);

} // namespace reljef::gl
