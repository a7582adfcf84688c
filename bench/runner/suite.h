#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "bench/report/results.h"
#include "bench/runner/benchmark_scene.h"
#include "bench/runner/suite_options.h"

namespace reljef::bench {

/// A row before it is measured.
struct Candidate {
    Setting setting;
    std::optional<scene::Technique> technique; ///< absent: not implemented yet
    std::optional<SourceFigure> source;
};
Candidate candidate_of(const scene::Technique& technique);
/// Texture, then the others.
std::vector<Candidate> candidates_of(const std::vector<scene::Technique>& techniques);

/// What is measured interleaved: settings on one stage from one pose.
struct Group {
    std::string test; ///< of the sources; may be empty
    SceneChoice scene;
    scene::Pose pose = scene::Pose::overview;
    /// The first is texture, which the others are told in terms of. Its null row comes by itself.
    std::vector<Candidate> candidates;
};

struct Suite {
    std::string name;
    std::vector<Group> groups;
    bool keep_scenes = true; ///< all opened before anything is measured, see BenchmarkScenes
    int max_view_cols = 0;   ///< of a row's pictures, see RowViews
    /// Whether a quick run leaves out candidates of a group where there is no time for them, the
    /// last first as far as it knows their cost; Results::left_out says which.
    bool may_leave_out = true;
};

/// Measures a suite group by group: first how wrong each candidate's picture is, then how fast it
/// is drawn. The rows are in the groups' order, each group's null row last. A run that is stopped
/// or fails on the way keeps the rows it has, and says why in Results::stopped; stopped, it still
/// draws once what it has judged. Fails without groups.
Results run_suite(const Suite& suite, const SuiteOptions& options, const std::stop_token& stop);

} // namespace reljef::bench
