#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "bench/report/figure_table.h"
#include "bench/report/results.h"
#include "bench/runner/suite_options.h"

namespace reljef::bench {

struct DistanceOptions {
    SuiteOptions suite;
    std::vector<std::string> terrains{"urban", "natural"};
    std::vector<scene::Technique> techniques{{scene::Texture{}},
                                             {scene::Parallax{}},
                                             {scene::Relief{}},
                                             {scene::Relief{.bisection_steps = 16}},
                                             {scene::Exact{}}};
    std::vector<double> distances{100.0, 300.0, 1000.0, 3000.0, 10'000.0}; ///< of the eye, metres
};

/// The error of a technique from a distance.
struct DistanceRow {
    std::string scene;
    double distance = 0.0; ///< metres
    std::string label;     ///< of the technique
    RowError error;
    double hidden_percent = 0.0; ///< see truth::hidden_places()
};

struct DistanceResults {
    DistanceOptions options;
    Environment environment;
    std::vector<DistanceRow> rows;
    RunEnd end;
};

/// "300 m", "10 km".
std::string distance_text(double metres);

FigureTable figure_table(const DistanceResults& results);

/// Measures errors from several distances, 35 degrees above the ground in the middle. Their
/// pictures do not depend on how busy the machine is.
DistanceResults run_distances(const DistanceOptions& options, const std::stop_token& stop);

} // namespace reljef::bench
