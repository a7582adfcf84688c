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

/// Reads what write_json_report() wrote. A run that ended early has Results::stopped again. Fails,
/// naming the file, the place, what was found and what was expected, where it is no JSON or only
/// its beginning, of another schema, or where anything in it is absent, of a wrong kind or out of
/// its range; keys beyond the schema are let pass.
Result<Results> read_json_report(const std::filesystem::path& file);

} // namespace reljef::bench
