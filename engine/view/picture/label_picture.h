#pragma once

#include <glm/vec2.hpp>

#include "engine/core/color.h"
#include "engine/view/picture/contour_labels.h"

namespace reljef::view {

/// The pixels that a label may change in a picture of `size` pixels; empty outside. Precondition:
/// the middle is finite.
scene::PicturePart label_area(const ContourLabel& label, double digit_height, glm::ivec2 size);

/// Draws a label: dark digits with a pale border. `first`: pixel of the picture at part(0, 0).
void draw_label(const ContourLabel& label, double digit_height, GridView<Rgba8> part,
                glm::ivec2 first);

} // namespace reljef::view
