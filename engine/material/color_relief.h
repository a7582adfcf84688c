#pragma once

#include "engine/core/color.h"
#include "engine/core/grid.h"

namespace reljef::material {

struct ColorReliefOptions {
    int octaves = 5; ///< frequency bands, 1 to 12; coarser ones are ignored
    bool dark_is_high = false;
    bool wraps = false; ///< the picture repeats; else it is mirrored at its border
};

/// Heights in [0,1] estimated from a picture, of the same size. Bright means high, because a
/// surface lit from the front reflects most light from its tops. Low frequencies are paint or shade
/// and are ignored. Each octave is weighted with its wavelength: equal contrast means equal slope.
/// The lowest and the highest hundredth are clipped. A picture without contrast gives 0.
/// Precondition: 1 <= octaves <= 12.
Grid<float> heights_from_colors(const Image& image, const ColorReliefOptions& options = {});

} // namespace reljef::material
