#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/report/report_json.h"
#include "engine/core/result.h"
#include "engine/core/statistics.h"

namespace reljef::bench {

/// How a run ended.
struct RunEnd {
    std::optional<Error> stopped; ///< why it ended early
    bool failed = false;          ///< by an error, not by request
};
/// The end of a run that measured something (`has_rows`) before it was stopped or failed.
RunEnd run_end(const Result<void>& done, const std::stop_token& stop, bool has_rows);

struct FigureColumn {
    std::string pointer; ///< into a JSON row, "/ms/median"; empty: only in tables
    std::string heading; ///< empty: only in the JSON
    int decimals = 2;    ///< of fractions in tables
};

/// The result of a suite that has columns of its own.
struct FigureTable {
    std::string schema = {};
    std::string heading = {};                      ///< what was measured, on which device
    nlohmann::ordered_json settings = {};          ///< further keys of the JSON, an object
    std::vector<FigureColumn> columns = {};        ///< empty: `heading` says everything
    std::vector<nlohmann::ordered_json> rows = {}; ///< arrays with one value for each column
    std::string summary = {};                      ///< below the table
    RunEnd end = {};
};

/// {"median", "p95", "p99"}.
nlohmann::ordered_json json_of(const Summary& summary);

/// Each row as an object. Infinite and missing figures are null.
std::string figure_json(const FigureTable& table);
std::string figure_text(const FigureTable& table);
std::string figure_markdown(const FigureTable& table);

/// Writes the files (empty paths: none) unless the run failed, and prints the table. Fails if a
/// file cannot be written, and with RunEnd::stopped.
Result<void> report(const FigureTable& table, const std::filesystem::path& json,
                    const std::filesystem::path& markdown = {});

} // namespace reljef::bench
