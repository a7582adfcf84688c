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

using FigureJson = nlohmann::ordered_json;

struct RunEnd {
    std::optional<Error> stopped; ///< why it ended early
    bool failed = false;          ///< by an error, not by request
};
/// `has_rows`: the run measured something before it was stopped or failed.
RunEnd run_end(const Result<void>& done, const std::stop_token& stop, bool has_rows);

struct FigureColumn {
    std::string pointer; ///< into a JSON row, "/ms/median"; empty: only in tables
    std::string heading; ///< empty: only in the JSON
    int decimals = 2;    ///< of fractions in tables
};

/// The result of a suite with its own columns.
struct FigureTable {
    std::string schema = {};
    std::string heading = {};               ///< terrain, options and device
    FigureJson settings = {};               ///< an object: more keys of the JSON
    std::vector<FigureColumn> columns = {}; ///< may be empty
    std::vector<FigureJson> rows = {};      ///< arrays, one value per column
    std::string summary = {};               ///< below the table
    RunEnd end = {};
};

/// "1024x768".
std::string size_text(glm::ivec2 size);

/// {"median", "p95", "p99"}.
FigureJson json_of(const Summary& summary);

/// Each row is an object. Infinite and absent figures are null.
std::string figure_json(const FigureTable& table);
std::string figure_text(const FigureTable& table);
std::string figure_markdown(const FigureTable& table);

/// Writes the files (empty paths: none) unless the run failed, and prints the table. Fails if a
/// file cannot be written, and with RunEnd::stopped.
Result<void> report(const FigureTable& table, const std::filesystem::path& json,
                    const std::filesystem::path& markdown = {});

} // namespace reljef::bench
