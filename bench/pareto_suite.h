#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "bench/results.h"
#include "bench/suite_options.h"

namespace reljef::bench {

struct ParetoOptions {
    SuiteOptions suite;
    /// Empty: natural and urban, of quick_samples a side where the run is quick.
    std::vector<std::string> terrains;
    std::vector<scene::Technique> techniques; ///< beside texture; empty: settings_over_range()
};

/// A quarter of a side of the built-in terrains: so polygons and cones, too, are measured in a
/// minute.
inline constexpr int quick_samples = 257;

/// At most so many values of one parameter are measured.
inline constexpr int most_values = 5;

/// Values over the range of a parameter, its ends and its default among them, at most `most_values`
/// and the default; in even steps of the logarithm where the range is above 0 and its end over ten
/// times its beginning, else in even steps. Whole where it is. Ascending, none twice.
std::vector<double> values_over_range(const scene::ParameterInfo& parameter);

/// Every technique there is as it is by default, the cheapest first by its kind: the flat one,
/// parallax, searches, exact, what is prepared beforehand, triangles; then each with one parameter
/// at a time over its range, as far as the catalogue takes it, the values next to the default
/// first. None twice.
std::vector<scene::Technique> settings_over_range();

/// Time against error: the settings on each terrain from each of the poses overview, oblique, low
/// and grazing, and the front of each (pareto_front.h), without an area where the default of a
/// technique was left out. See run_suite().
Results run_pareto(const ParetoOptions& options, const std::stop_token& stop);

} // namespace reljef::bench
