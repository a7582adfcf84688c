#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "bench/report/results.h"
#include "bench/runner/benchmark_scene.h"
#include "bench/runner/suite_options.h"

namespace reljef::bench {

struct Candidate {
    scene::Technique technique;
    std::optional<SourceFigure> source = {};
    bool by_rays = false; ///< drawn by rays on the CPU (session::BackendKind::cpu)
};
/// Texture, then the other techniques.
std::vector<Candidate> candidates_of(const std::vector<scene::Technique>& techniques);

/// Settings of one scene and pose, whose frames are measured interleaved.
struct Group {
    std::string test; ///< of the sources; may be empty
    SceneChoice scene;
    scene::Pose pose = scene::Pose::overview;
    /// The first is texture. The null row is added automatically.
    std::vector<Candidate> candidates;
};

struct Suite {
    std::string name;
    std::vector<Group> groups;
    bool keep_scenes = true; ///< opens all scenes before measuring, see BenchmarkScenes
    int max_view_cols = 0;   ///< of a row's pictures, see RowViews
    /// Whether a quick run may leave out candidates when time runs out, see Results::left_out.
    bool may_leave_out = true;
};

/// Measures a suite group by group: first the error of each candidate, then its frame time. Rows
/// are in the order of the groups, each group's null row last. A run that is stopped or fails keeps
/// its rows; after a stop it draws the checked candidates once. A scene that cannot be opened or
/// measured is a note, and the run fails at its end. Fails without groups. With
/// session::BackendKind::cpu, OpenGL draws the candidates, and rays on the CPU beside it those that
/// are exact or keep an error bound; their labels say so.
Results run_suite(const Suite& suite, const SuiteOptions& options, const std::stop_token& stop);

} // namespace reljef::bench
