#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "bench/report/results.h"
#include "bench/runner/suite_options.h"

namespace reljef::bench {

struct LodOptions {
    SuiteOptions suite;
    std::vector<std::string> terrains{"natural", "urban"};
};

/// Polygons by levels and by error on each terrain from each of the poses overview, oblique, low
/// and grazing, with a still camera: tiles are cut and uploaded before they are timed. See
/// run_suite().
Results run_lod(const LodOptions& options, const std::stop_token& stop);

} // namespace reljef::bench
