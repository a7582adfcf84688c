#pragma once

#include <optional>
#include <string>

#include "bench/report/results.h"

namespace reljef::bench {

/// A row to be: its setting, and what is known of it before it is measured.
struct Candidate {
    Setting setting;
    std::optional<scene::Technique> technique; ///< absent: it does not exist yet
    std::optional<SourceFigure> source;
};

/// The candidate of a technique, which must exist.
Candidate candidate_of(const scene::Technique& technique);

/// The candidate of "ID:key=value,…"; without a technique where the catalogue has none such or
/// refuses its parameters.
Candidate candidate_named(const std::string& text);

} // namespace reljef::bench
