#pragma once

#include <string>

#include "bench/report/results.h"

namespace reljef::test {

/// 20 frames whose median is `median_ms`, its interval 10 % to either side, the noise floor 5 %.
bench::Timing made_timing(double median_ms, double ratio);

/// An error whose RMS of reprojection is `rms_px`.
bench::RowError made_error(double rms_px);

/// A run on the scene `scene`: texture, polygons that take four times as long, and the null row.
bench::Results made_results(const std::string& scene = "natural");

/// The same as the sources' test relief-4, with their figures and a row of relief.
bench::Results made_source_results();

} // namespace reljef::test
