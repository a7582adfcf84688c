#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "bench/report/results.h"
#include "bench/runner/suite_options.h"

namespace reljef::bench {

struct TablesOptions {
    SuiteOptions suite;
    /// "gallery" stands for its detail textures (gallery_tiles.h). Empty: natural and urban, or the
    /// tests of the sources if `techniques` and `pose` are empty, too.
    std::vector<std::string> terrains;
    /// Besides texture; empty: the default of every technique.
    std::vector<scene::Technique> techniques;
    /// Absent: overview; of detail textures oblique.
    std::optional<scene::Pose> pose;
};

/// Measures the tests of the sources (source_tests.h) or techniques on terrains. See run_suite().
Results run_tables(const TablesOptions& options, const std::stop_token& stop);

} // namespace reljef::bench
