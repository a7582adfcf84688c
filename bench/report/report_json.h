#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "bench/report/results.h"

namespace reljef::bench {

/// What a results file says it is, under "schema".
inline constexpr std::string_view schema_name = "reljef-bench/1";

nlohmann::ordered_json json_of(const Environment& environment);

/// The results as JSON of the schema schema_name. Shares are fractions, times milliseconds. Every
/// row has every key; what could not be or is not measured is null, "taps" everywhere. "complete"
/// is false where the run ended early, as "stopped" says, or left settings out, as "left_out" says.
std::string json_report(const Results& results);

/// Writes json_report(), whole or not at all.
Result<void> write_json_report(const std::filesystem::path& file, const Results& results);

/// Reads what write_json_report() wrote. A run that ended early has Results::stopped again. Fails,
/// naming the file, the place, what was found and what was expected, where it is no JSON or only
/// its beginning, of another schema, or where anything in it is absent, of a wrong kind or out of
/// its range; keys beyond the schema are let pass.
Result<Results> read_json_report(const std::filesystem::path& file);

} // namespace reljef::bench
