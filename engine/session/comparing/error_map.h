#pragma once

#include "engine/core/color.h"
#include "engine/truth/geometric_error.h"

namespace reljef::session {

/// The colours of the error map grow with the logarithm of the error between these, pixels.
inline constexpr double min_mapped_error = 0.1;
inline constexpr double max_mapped_error = 10.0;

/// Of an error in pixels; below min_mapped_error the map shows the grey picture.
Rgba8 error_color(double pixels);
/// Of pixels that show another part of the terrain although they are hardly off: ground behind the
/// true one.
inline constexpr Rgba8 wrong_color{96, 208, 96, 255};
/// Of pixels without terrain where there is some.
inline constexpr Rgba8 hole_color{64, 224, 255, 255};
/// Of pixels that show a surface where there is none, or an unbounded error.
inline constexpr Rgba8 unbounded_color{255, 64, 220, 255};

/// The errors of a picture in colours over the exact picture in grey. Precondition: equal sizes.
Image error_map(const truth::GeometricErrors& errors, const Image& truth);

} // namespace reljef::session
