#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "bench/stress/stress_results.h"

namespace reljef::bench {

/// "moved-scene", "grazing-view", …, in the order of their rows.
std::vector<std::string> stress_names();

/// Runs the stresses: those of the options, or all; a quick run leaves out those over terrain
/// larger than memory. A stress that fails becomes a row over its limit. Terrains that cannot be
/// opened are left out and named at the end. Keeps its rows when it is stopped.
StressResults run_stress(const StressOptions& options, const std::stop_token& stop);

} // namespace reljef::bench
