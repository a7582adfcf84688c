#pragma once

#include "engine/core/result.h"

namespace reljef::view {

/// The driver's choice of the samples of a pixel: 4 where edges of triangles or surfaces are seen
/// (render::Driver, cast::Driver), else 1.
inline constexpr int automatic_samples = 0;
/// That choice of render::Driver for pictures with triangles.
inline constexpr int samples_of_triangles = 4;

/// Fails unless `samples` is 1, 2, 4, 8, 16 or automatic_samples.
Result<void> check_samples(int samples);

} // namespace reljef::view
