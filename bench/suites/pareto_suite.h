#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "bench/report/results.h"
#include "bench/runner/suite.h"
#include "bench/runner/suite_options.h"
#include "engine/core/parallel_for.h"

namespace reljef::bench {

struct ParetoOptions {
    SuiteOptions suite;
    /// Empty: the gallery (gallery_tiles.h), natural and urban, in a quick run with quick_samples a
    /// side; techniques are then measured only on scenes that they suit.
    std::vector<std::string> terrains;
    std::vector<scene::Technique> techniques; ///< besides texture; empty: settings_over_range()
    Shard shard = {};                         ///< of the scenes and poses
};

/// A quarter of the default side: a minute then suffices for polygons and cones, too.
inline constexpr int quick_samples = 257;

/// Maximum number of values of one parameter, besides its default.
inline constexpr int max_values = 5;

/// Up to max_values values over the range of a parameter, with both ends, and its default: in equal
/// steps of the logarithm if the range is positive and its end is more than 10 times its beginning,
/// else in equal steps; rounded for whole parameters. Ascending, distinct.
std::vector<double> values_over_range(const scene::NumberInfo& parameter);

/// The default of every technique, sorted by the typical cost of its kind: flat, parallax,
/// searches, exact, precomputed, triangles. Then every technique with one parameter varied over its
/// range, the values next to the default first. Distinct settings that the catalogue accepts.
std::vector<scene::Technique>
settings_over_range(const std::vector<scene::TechniqueInfo>& techniques);

/// `relief` with one option at a time; options with numbers have their defaults.
std::vector<scene::Technique> settings_of_options();

/// The scenes, poses and settings of run_pareto(), those of the shard. Chosen techniques are
/// skipped on detail textures and default terrains that they do not suit.
std::vector<Group> pareto_groups(const ParetoOptions& options);

/// Measures the settings on each terrain from the poses overview, oblique, low and grazing, and on
/// each detail texture of the gallery from oblique, with the options. Adds the Pareto fronts. Fails
/// if no technique suits any scene. See run_suite().
Results run_pareto(const ParetoOptions& options, const std::stop_token& stop);

} // namespace reljef::bench
