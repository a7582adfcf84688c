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
    /// Every technique on each of them, of the gallery on its tiles (gallery_tiles.h); empty, and
    /// `techniques` too: the sources' tests; empty otherwise: natural and urban.
    std::vector<std::string> terrains;
    /// On the terrains, beside texture, which is always measured; empty: every technique as it is
    /// by default.
    std::vector<scene::Technique> techniques;
    /// From where; absent: the sources' tests, or overview, of the gallery's tiles oblique.
    std::optional<scene::Pose> pose;
};

/// The sources' seven tests (source_tests.h), or the techniques on terrains of one's own, the whole
/// terrain in view unless the pose says otherwise. Techniques of the sources that do not exist yet
/// are missing rows. See run_suite().
Results run_tables(const TablesOptions& options, const std::stop_token& stop);

} // namespace reljef::bench
