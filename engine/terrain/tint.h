#pragma once

#include "engine/core/color.h"
#include "engine/terrain/heightfield.h"

namespace reljef::terrain {

/// A hypsometric tint (Imhof's scale: green lowland, ochre, brown, grey, white), one pixel per
/// sample, stretched over the 1st to 99th percentile of the heights. Level samples at exactly 0 m
/// are water, voids are a neutral grey.
Image hypsometric_tint(const Heightfield& heightfield);

/// `color` over `beneath` where it is transparent (alpha < 255); where it is empty, `beneath`
/// alone. Opaque, of the size of `color` (or of `beneath`).
Image composite(const Image& color, const Image& beneath);

} // namespace reljef::terrain
