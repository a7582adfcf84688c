#pragma once

#include "engine/core/color.h"
#include "engine/core/hit.h"
#include "engine/view/draw_list.h"

namespace reljef::view {

/// sRGB colours of what `auto` chose: triangles, rays over a tile of a level (0: the finest), and a
/// search without a proof.
Rgba8 color_of_triangles();
Rgba8 color_of_rays(int level);
Rgba8 color_of_typical();

/// Tints each pixel of a terrain by what draws its tile, and keeps its brightness. Precondition:
/// picture and hits have the same size, and are those of the list.
void tint_choice(Image& picture, const HitBuffer& hits, const DrawList& list);

} // namespace reljef::view
