#include "bench/suites/lod_suite.h"

#include <array>

#include "bench/runner/suite.h"

namespace reljef::bench {
namespace {

constexpr std::array lod_poses{scene::Pose::overview, scene::Pose::oblique, scene::Pose::low,
                               scene::Pose::grazing};

std::vector<Candidate> lod_candidates() {
    std::vector<Candidate> candidates;
    for (const char* setting :
         {"texture", "polygons:lods=1", "polygons:lods=3", "polygons:lods=5", "polygons:error=0.25",
          "polygons:error=0.5", "polygons:error=1", "polygons:error=2", "polygons:error=4"}) {
        candidates.push_back(candidate_of(scene::parse_technique(setting).value()));
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
