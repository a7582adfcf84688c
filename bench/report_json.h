#pragma once

#include <filesystem>
#include <string>

#include "bench/results.h"

namespace reljef::bench {

/// The results as JSON of the schema "reljef-bench/1". Shares are fractions, times milliseconds;
/// what could not be measured is null. "complete" is false where the run ended early.
std::string json_report(const Results& results);

/// Writes json_report(), whole or not at all.
Result<void> write_json_report(const std::filesystem::path& file, const Results& results);

} // namespace reljef::bench
