#include "bench/runner/candidate.h"

namespace reljef::bench {

Candidate candidate_of(const scene::Technique& technique) {
    return {setting_of(technique), technique, std::nullopt};
}

} // namespace reljef::bench
