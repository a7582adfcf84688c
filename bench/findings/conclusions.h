#pragma once

#include <vector>

#include "bench/findings/conclusion.h"

namespace reljef::bench {

/// All conclusions of the sources: D (Dachsbacher), M (Mile 2008), J (Janković 2010).
Findings all_findings();

// Their parts.
std::vector<Chapter::Sentence> findings_summary();
std::string findings_limits();
Chapter relief_chapter();
Chapter parallax_chapter();
Chapter triangles_chapter();
Chapter objects_chapter();
Chapter search_chapter();
std::vector<Conclusion> ray_searches(); // of the search chapter
Chapter view_chapter();
Chapter light_chapter();
Chapter options_chapter();
Chapter data_chapter();

} // namespace reljef::bench
