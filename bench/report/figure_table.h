#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <nlohmann/json.hpp>

#include "bench/report/results.h"
#include "engine/core/result.h"
#include "engine/core/statistics.h"

namespace reljef::bench {

class JsonReader;

using FigureJson = nlohmann::ordered_json;

/// Lines as one, with "; " between them.
std::string in_one_line(const std::string& lines);

struct RunEnd {
    std::optional<Error> stopped; ///< why it ended early; a line for each reason
    bool failed = false;          ///< by an error, not by request
};
/// `has_rows`: the run measured something before it was stopped or failed.
RunEnd run_end(const Result<void>& done, const std::stop_token& stop, bool has_rows);

/// A member of each row of a document (docs/results.md).
struct FigureColumn {
    enum class Role {
        group,    ///< its values name tables of rows
        name,     ///< its values name a row of its table
        measured, ///< a figure of a row
    };
    enum class Better { none, less, more };

    std::string key; ///< JSON pointer into a row, "/ms/median"
    std::string heading;
    std::string unit = {}; ///< "ms", "px", "bytes" …; empty: none
    Role role = Role::measured;
    Better better = Better::none; ///< none: not compared
    int decimals = 2;             ///< of fractions in tables; not in the JSON
    bool is_detail = false;       ///< not in tables of text
    std::string noise = {};       ///< key of the noise floor, a share; empty: it has none
    std::string limit = {};       ///< key of the largest allowed value; empty: it has none
};

/// Makers of columns.
namespace columns {
FigureColumn group(std::string key, std::string heading);
FigureColumn name(std::string key, std::string heading);
FigureColumn less(std::string key, std::string heading, std::string unit = {}, int decimals = 2);
FigureColumn more(std::string key, std::string heading, std::string unit = {}, int decimals = 2);
/// A figure that is neither better nor worse.
FigureColumn plain(std::string key, std::string heading, std::string unit = {}, int decimals = 2);
/// The column in files only.
FigureColumn detail(FigureColumn column);
} // namespace columns

/// The results of a suite with its own columns.
struct FigureTable {
    std::string suite = {};
    Environment environment = {};
    Shard shard = {};                           ///< the part of the run
    FigureJson settings = FigureJson::object(); ///< what the options said
    FigureJson summary = {};                    ///< figures of the whole run; null: none
    std::vector<FigureColumn> columns = {};     ///< at least one
    std::vector<FigureJson> rows = {};          ///< arrays, one value per column
    std::vector<std::string> notes = {};        ///< sentences, shown below the tables
    RunEnd end = {};
};

inline PartOrigin origin_of(const FigureTable& part) {
    return {part.shard, part.environment};
}

/// "1024x768".
std::string size_text(glm::ivec2 size);

/// "plain", "median ms"; bytes are shown as "MB".
std::string heading_text(const FigureColumn& column);

/// The number, or null.
template <class Value> FigureJson json_or_null(const std::optional<Value>& value) {
    return value ? FigureJson(*value) : FigureJson();
}

/// A document with columns. Infinite and absent figures are null.
std::string figure_json(const FigureTable& table);
/// One table for each group, without columns that have no value there. A single row is shown as
/// lines of name and value.
std::string figure_text(const FigureTable& table);
std::string figure_markdown(const FigureTable& table);
/// A heading of keys, and one line for each row (RFC 4180, but lines end in '\n').
std::string figure_csv(const FigureTable& table);

/// Reads a document with columns; the settings' order and the decimals are lost. Sets the error of
/// the document.
FigureTable read_figures(JsonReader& document);

} // namespace reljef::bench
