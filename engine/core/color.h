#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "engine/core/grid.h"

namespace reljef {

/// 8 bits per channel; r, g, b are sRGB-encoded, a is linear.
struct Rgba8 {
    std::uint8_t r = 0;
    std::uint8_t g = 0;
    std::uint8_t b = 0;
    std::uint8_t a = 255;

    friend bool operator==(const Rgba8&, const Rgba8&) = default;
};
static_assert(sizeof(Rgba8) == 4);

/// A picture, row 0 at the top (north for a map).
using Image = Grid<Rgba8>;

/// Linear to sRGB-encoded, both in [0,1] (IEC 61966-2-1). Clamps its input; NaN gives 0.
float srgb_from_linear(float linear);

/// sRGB-encoded to linear, both in [0,1] (IEC 61966-2-1).
float linear_from_srgb(float encoded);

/// The nearest 8-bit sRGB colour; clamps channels to [0,1].
Rgba8 rgba8_from_linear(glm::vec3 linear, std::uint8_t alpha = 255);

/// Linear r, g, b in [0,1]; ignores alpha.
glm::vec3 linear_from_rgba8(Rgba8 color);

} // namespace reljef
