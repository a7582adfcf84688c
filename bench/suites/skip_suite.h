#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "bench/report/results.h"
#include "bench/runner/suite_options.h"
#include "engine/core/parallel_for.h"
#include "engine/scene/motion/poses.h"

namespace reljef::bench {

struct SkipOptions {
    SuiteOptions suite;
    std::vector<std::string> terrains; ///< empty: natural and urban
    std::vector<scene::Pose> poses;    ///< empty: overview, low, grazing and valley; quick: low
    std::vector<std::string> kinds;    ///< names of SkipKind; empty: all
    /// For the tests of streams. Files that fit are not measured as streams; a note says so.
    int memory_megabytes = 16;
    Shard shard = {}; ///< of the scenes and poses
};

/// Draws each scene and pose with everything skipped and without each kind of skipping in turn
/// (skip_kinds.h): compares pictures and hits, counts the work, and measures interleaved. The last
/// row of each test skips everything again, for the noise floor. Tests that a terrain or the
/// context cannot draw are noted. With
/// session::BackendKind::cpu, only rays on the CPU are measured.
Results run_skip(const SkipOptions& options, const std::stop_token& stop);

/// Fails with the first row whose picture is not the same, see RowSkip::Difference::is_allowed().
Result<void> check_same_pictures(const Results& results);

} // namespace reljef::bench
