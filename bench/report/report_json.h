#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/report/results.h"

namespace reljef::bench {

class JsonReader;

/// "schema" of a results file.
inline constexpr std::string_view schema_name = "reljef-bench/1";

nlohmann::ordered_json json_of(const Environment& environment);

/// What each document begins with (docs/results.md).
struct ReportHead {
    std::string suite = {};            ///< "tables", "peers"; files of earlier versions: empty
    bool complete = true;              ///< it has all rows
    std::optional<Error> stopped = {}; ///< why the run ended early
    std::vector<std::string> notes = {};
    Environment environment = {};
    Shard shard = {}; ///< the part of the run
};
nlohmann::ordered_json json_of(const ReportHead& head);
/// "stopped" is also set if the run is not complete for another reason.
ReportHead read_head(JsonReader& document);

/// The results as JSON of schema schema_name, without "columns": rows of techniques. Shares are
/// fractions, times milliseconds. Every row has every key; absent figures are null. "taps" counts a
/// pixel's, "work" a picture's. "missing" is always false: earlier versions listed techniques that
/// did not exist yet. "complete" is false if the run ended early ("stopped") or left settings out
/// ("left_out").
std::string json_report(const Results& results);

/// Reads the JSON of any suite. Fails if the file is a device, too large or no whole JSON document.
Result<nlohmann::json> read_result_json(const std::filesystem::path& file);

/// Passes the document of a report to `read`. Fails as read_result_json(), if the schema is not
/// schema_name, and with the first error of the reader.
Result<void> read_report(const std::filesystem::path& file,
                         const std::function<void(JsonReader& document)>& read);

/// Reads rows of techniques; skips missing ones. Sets Results::stopped if the run ended early, and
/// the error of the document. Ignores unknown keys.
Results read_results(JsonReader& document);

/// Reads a file of rows of techniques as read_results(). Fails, with the place, what was found and
/// what was expected, if the file is no whole JSON document, has another schema or columns, or a
/// value is absent, of a wrong type or out of range.
Result<Results> read_json_report(const std::filesystem::path& file);

} // namespace reljef::bench
