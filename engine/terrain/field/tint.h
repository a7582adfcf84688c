#pragma once

#include "engine/core/color.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::terrain {

/// Imhof's colours, stretched over the 1st to 99th percentile of a heightfield.
class HeightTint {
public:
    explicit HeightTint(const Heightfield& heightfield);

    [[nodiscard]] Rgba8 at(double height) const; ///< metres
    static constexpr Rgba8 water{82, 118, 148, 255};
    static constexpr Rgba8 no_data{128, 128, 128, 255};

private:
    HeightRange range_;
};

/// HeightTint for each sample. Level ground at exactly 0 m is water; voids are grey.
Image hypsometric_tint(const Heightfield& heightfield);

/// Blends `color` over `beneath`. The result is opaque and has the size of `color`. If `color` is
/// empty, it is `beneath`.
Image composite(const Image& color, const Image& beneath);

} // namespace reljef::terrain
