#pragma once

#include <stop_token>
#include <string>

#include <glm/vec2.hpp>

#include "bench/claims/cut_city.h"
#include "bench/runner/measure.h"
#include "engine/core/grid.h"
#include "engine/core/result.h"

namespace reljef::bench {

/// What measure_warp_phases() times, in its order.
inline constexpr const char* warp_phase_names[] = {"moved points", "moved and rebuilt"};

/// The two phases of forward warping (Oliveira, Bishop and McAllister 2000): moving each sample of
/// a surface to the place where an eye sees it on the plane, and rebuilding a picture from the
/// moved samples. From an oblique view of the whole surface.
Result<Measurement> measure_warp_phases(const CutCity& city, const MeasureOptions& options,
                                        unsigned threads);

} // namespace reljef::bench
