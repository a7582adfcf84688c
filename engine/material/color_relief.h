#pragma once

#include "engine/core/color.h"
#include "engine/core/grid.h"

namespace reljef::material {

struct ColorReliefOptions {
    int octaves =
        5; ///< bands of detail, each twice as coarse; what is coarser is no relief, 1 to 12
    bool dark_is_high = false;
    /// Whether the picture goes on in its own copies; else it is mirrored at its border.
    bool wraps = false;
};

/// Heights in [0,1] guessed from a picture, of its size: an impression of relief, not a
/// measurement. Nothing in one picture tells a dark plank from a deep one: it takes bright for
/// high, as the sources' filter of specular light did (a surface lit from the front sends most
/// light from its tops), but leaves out what changes only over long ways, which is paint or shade
/// rather than relief, and counts each octave of detail with its wave length, so that the same
/// contrast means the same slope at every size. The lowest and the highest hundredth are cut off. A
/// picture without contrast gives 0 everywhere. Precondition: 1 <= octaves <= 12.
Grid<float> heights_from_colors(const Image& image, const ColorReliefOptions& options = {});

} // namespace reljef::material
