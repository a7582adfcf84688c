#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "bench/report/results.h"

namespace reljef::bench {

class JsonReader;

/// "schema" of a results file.
inline constexpr std::string_view schema_name = "reljef-bench/1";

nlohmann::ordered_json json_of(const Environment& environment);

/// The results as JSON of schema schema_name. Shares are fractions, times milliseconds. Every row
/// has every key; absent figures are null. "taps" counts a pixel's, "work" a picture's. "missing"
/// is always false: earlier versions listed techniques that did not exist yet. "complete" is false
/// if the run ended early
/// ("stopped") or left settings out ("left_out").
std::string json_report(const Results& results);

/// Reads the JSON of any suite. Fails if the file is a device, too large or no whole JSON document.
Result<nlohmann::json> read_result_json(const std::filesystem::path& file);

/// Passes the document of a report to `read`. Fails as read_result_json(), if the schema is another
/// one, and with the first error of the reader.
Result<void> read_report(const std::filesystem::path& file, std::string_view schema,
                         const std::function<void(JsonReader& document)>& read);

/// "environment" and "shard" of a report.
PartOrigin read_origin(JsonReader& document);

/// Why the run of a report ended early: "stopped"; absent if it is complete.
std::optional<Error> read_stopped(JsonReader& document);

/// Reads a JSON report; skips missing rows. Sets Results::stopped if the run ended early. Fails,
/// with the place, what was found and what was expected, if the file is no whole JSON document, has
/// another schema, or a value is absent, of a wrong type or out of range. Ignores unknown keys.
Result<Results> read_json_report(const std::filesystem::path& file);

} // namespace reljef::bench
