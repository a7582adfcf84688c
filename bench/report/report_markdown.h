#pragma once

#include <string>

#include "bench/report/results.h"

namespace reljef::bench {

/// The rows as tables in Markdown (GitHub's), with what they were measured on. What a name holds is
/// text, never markup.
std::string markdown_report(const Results& results);

} // namespace reljef::bench
