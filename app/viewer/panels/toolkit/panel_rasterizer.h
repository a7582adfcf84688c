#pragma once

#include <cstdint>

#include <imgui.h>

#include "app/viewer/panels/toolkit/pixel_area.h"
#include "engine/core/color.h"
#include "engine/core/grid.h"

namespace reljef::app {

/// Draws panels into an area of a picture, on the CPU. As with OpenGL, a pixel belongs to the
/// triangle with its centre, or to that right of it or above; colours are blended as bytes, and
/// letters have the nearest texel.
/// `letters`: the alpha of the font atlas, to which all texture coordinates refer. Preconditions:
/// the area lies in the picture, which is opaque; the data has no callbacks.
void rasterize(const ImDrawData& panels, GridView<const std::uint8_t> letters,
               const PixelArea& area, Image& picture);

} // namespace reljef::app
