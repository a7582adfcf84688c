#pragma once

#include <array>
#include <cstddef>

#include "engine/core/color.h"

namespace reljef::bench {

/// The ends of the scale of errors, pixels: what lies beyond has the colour of the end.
inline constexpr double heat_low_px = 0.01;
inline constexpr double heat_high_px = 100.0;

/// The colour of an error without a bound; in no part of the scale.
inline constexpr Rgba8 heat_unbounded{255, 0, 255, 255};

/// Colours of errors from heat_low_px to heat_high_px, evenly spaced by their logarithm: 16 to a
/// tenfold. Lightness grows evenly with it (Kovesi 2015, "Good Colour Maps: How to Design Them"),
/// measured in Oklab.
inline constexpr std::size_t heat_levels = 64;
std::array<Rgba8, heat_levels> heat_scale();

/// A picture of an error at every pixel, in pixels: the colours of heat_scale(), heat_unbounded
/// where it is infinite, and a grey hatch where it is NaN, that is, where there is none.
/// Precondition: no error is negative.
Image heat_map(const Grid<float>& error_px);

} // namespace reljef::bench
