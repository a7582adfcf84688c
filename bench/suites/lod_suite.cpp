#include "bench/suites/lod_suite.h"

#include <array>

#include "bench/runner/suite.h"

namespace reljef::bench {
namespace {

constexpr std::array lod_poses{scene::Pose::overview, scene::Pose::oblique, scene::Pose::low,
                               scene::Pose::grazing};

std::vector<Candidate> lod_candidates() {
    std::vector<Candidate> candidates{candidate_of(scene::Technique{scene::Texture{}})};
    for (const int levels : {1, 3, 5}) {
        candidates.push_back(candidate_of(scene::Technique{scene::Polygons{.max_levels = levels}}));
    }
    for (const double error : {0.25, 0.5, 1.0, 2.0, 4.0}) {
        candidates.push_back(candidate_of(scene::Technique{scene::Polygons{.error = error}}));
    }
    return candidates;
}

} // namespace

Results run_lod(const LodOptions& options, const std::stop_token& stop) {
    Suite suite{"lod", {}};
    for (const std::string& terrain : options.terrains) {
        for (const scene::Pose pose : lod_poses) {
            suite.groups.push_back({"", {terrain}, pose, lod_candidates()});
        }
    }
    return run_suite(suite, options.suite, stop);
}

} // namespace reljef::bench
