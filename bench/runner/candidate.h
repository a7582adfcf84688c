#pragma once

#include <optional>

#include "bench/report/results.h"

namespace reljef::bench {

/// A row to be: its setting, and what is known of it before it is measured.
struct Candidate {
    Setting setting;
    std::optional<scene::Technique> technique; ///< absent: it does not exist yet
    std::optional<SourceFigure> source;
};

/// The candidate of a technique.
Candidate candidate_of(const scene::Technique& technique);

} // namespace reljef::bench
