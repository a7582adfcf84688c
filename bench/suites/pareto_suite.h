#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "bench/report/results.h"
#include "bench/runner/suite.h"
#include "bench/runner/suite_options.h"

namespace reljef::bench {

struct ParetoOptions {
    SuiteOptions suite;
    /// Empty: the gallery's tiles (gallery_tiles.h), natural and urban, of quick_samples a side
    /// where the run is quick; of the chosen techniques each on those that it suits.
    std::vector<std::string> terrains;
    std::vector<scene::Technique> techniques; ///< beside texture; empty: settings_over_range()
};

/// A quarter of a side of the built-in terrains: so polygons and cones, too, are measured in a
/// minute.
inline constexpr int quick_samples = 257;

/// At most so many values of one parameter are measured.
inline constexpr int max_values = 5;

/// Values over the range of a parameter, its ends and its default among them, at most `max_values`
/// and the default; in even steps of the logarithm where the range is above 0 and its end over ten
/// times its beginning, else in even steps. Whole where it is. Ascending, none twice.
std::vector<double> values_over_range(const scene::NumberInfo& parameter);

/// Every technique of a list as it is by default, the cheapest first by its kind: the flat one,
/// parallax, searches, exact, what is prepared beforehand, triangles; then each with one parameter
/// at a time over its range, as far as the catalogue takes it, the values next to the default
/// first. None twice.
std::vector<scene::Technique>
settings_over_range(const std::vector<scene::TechniqueInfo>& techniques);

/// `relief` with each option there is, one at a time, as by default where it has numbers.
std::vector<scene::Technique> settings_of_options();

/// What run_pareto() measures: stages, poses and settings; of the chosen techniques each where it
/// suits, but on a terrain that was named all of them.
std::vector<Group> pareto_groups(const ParetoOptions& options);

/// Time against error: the settings on each terrain from each of the poses overview, oblique, low
/// and grazing, and on the gallery's tiles, those that suit each and the options, from oblique; and
/// the front of each (pareto_front.h), without an area where the default of a
/// technique was left out. Fails where a technique suits nothing of what is measured. See
/// run_suite().
Results run_pareto(const ParetoOptions& options, const std::stop_token& stop);

} // namespace reljef::bench
