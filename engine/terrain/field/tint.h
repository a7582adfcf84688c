#pragma once

#include "engine/core/color.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::terrain {

/// The colours of heights, Imhof's scale stretched over a heightfield's: for parts of the same
/// terrain that are read at another resolution.
class HeightTint {
public:
    explicit HeightTint(const Heightfield& heightfield);

    [[nodiscard]] Rgba8 at(double height) const; ///< metres
    static Rgba8 of_water();
    static Rgba8 of_void();

private:
    HeightRange range_;
};

/// A hypsometric tint (Imhof's scale: green lowland, ochre, brown, grey, white), one pixel per
/// sample, stretched over the 1st to 99th percentile of the heights. Level samples at exactly 0 m
/// are water, voids are a neutral grey.
Image hypsometric_tint(const Heightfield& heightfield);

/// `color` over `beneath` where it is transparent (alpha < 255); where it is empty, `beneath`
/// alone. Opaque, of the size of `color` (or of `beneath`).
Image composite(const Image& color, const Image& beneath);

} // namespace reljef::terrain
