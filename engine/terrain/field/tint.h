#pragma once

#include "engine/core/color.h"
#include "engine/core/grid.h"
#include "engine/terrain/field/color_ramp.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::terrain {

/// A ramp over a heightfield.
class HeightTint {
public:
    HeightTint(const ColorRamp& ramp, const Heightfield& heightfield);

    /// `height`: metres; `gradient`: ∂z/∂x, ∂z/∂y.
    [[nodiscard]] Rgba8 at(double height, glm::vec2 gradient) const {
        return rgba8(colors_.at(height, gradient));
    }
    [[nodiscard]] bool has_water() const { return has_water_; }
    [[nodiscard]] Rgba8 no_data() const { return no_data_; }
    static constexpr Rgba8 water{104, 137, 160, 255};

private:
    RampColors colors_;
    bool has_water_;
    Rgba8 no_data_;
};

/// Of each sample, 1: water. Level ground at exactly 0 m is sea. Other level ground is a lake if it
/// has at least `min_lake_samples` samples and nearly all ground around it is higher. Voids with
/// water nearly all around them are water.
Grid<std::uint8_t> water_mask(const Heightfield& heightfield);
inline constexpr int min_lake_samples = 60;

/// Of each sample, 1: it has the ramp's colour of no data. If the ramp names one, all voids have
/// it. Else these are the voids outside the data: they are connected with the border, and at least
/// a thousandth of all samples. Others are filled and coloured as ground. Empty if there are none.
Grid<std::uint8_t> no_data_mask(const Heightfield& heightfield, const ColorRamp& ramp);

/// HeightTint, water and no data for each sample.
Image hypsometric_tint(const Heightfield& heightfield, const ColorRamp& ramp);

/// Opaque; mixes encoded values. `share`: of `over`, [0, 1].
Rgba8 mixed(Rgba8 under, Rgba8 over, float share);

/// Blends `color` over `beneath`, with this share of its alpha, [0, 1]. The result is opaque and
/// has the size of `color`. If `color` is empty, it is `beneath`.
Image composite(const Image& color, const Image& beneath, double share = 1.0);

} // namespace reljef::terrain
