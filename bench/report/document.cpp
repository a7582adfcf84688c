#include "bench/report/document.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "bench/report/json_fields.h"
#include "bench/report/report_json.h"
#include "bench/report/result_parts.h"

namespace reljef::bench {
namespace {

using nlohmann::json;

// "/ms/median": keys of lowercase words, so that no pointer counts elements of an array.
bool is_key(const std::string& key) {
    if (key.size() < 2 || key.front() != '/' || key.back() == '/') {
        return false;
    }
    char before = ' ';
    for (const char c : key) {
        const bool is_letter = c >= 'a' && c <= 'z';
        const bool is_digit = c >= '0' && c <= '9';
        const bool is_good =
            before == '/' ? is_letter : is_letter || is_digit || c == '_' || c == '/';
        if (before != ' ' && !is_good) {
            return false;
        }
        before = c;
    }
    return true;
}

// The first column whose place another one has, or lies in or around; empty: there is none.
std::optional<std::size_t> misplaced_column(const std::vector<FigureColumn>& columns) {
    std::set<std::string> keys;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const auto [place, is_new] = keys.insert(columns[i].key + "/");
        const auto after = std::next(place);
        const bool is_alone = (place == keys.begin() || !place->starts_with(*std::prev(place))) &&
                              (after == keys.end() || !after->starts_with(*place));
        if (!is_key(columns[i].key) || !is_new || !is_alone) {
            return i;
        }
    }
    return std::nullopt;
}

bool is_number_or_absent(const json& value) {
    return value.is_null() || value.is_number();
}

} // namespace

// JsonReader::array() finds it by argument-dependent lookup.
static void describe(JsonReader& fields, FigureColumn& column) {
    std::string role;
    std::string better = "none";
    fields.field("key", column.key);
    fields.field("heading", column.heading);
    fields.field("role", role);
    fields.later_field("unit", column.unit);
    fields.later_field("better", better);
    fields.later_field("noise", column.noise);
    fields.later_field("limit", column.limit);
    fields.later_field("detail", column.is_detail);
    constexpr std::array<std::string_view, 3> roles{"group", "name", "measured"};
    constexpr std::array<std::string_view, 3> betters{"none", "less", "more"};
    const auto* const found_role = std::find(roles.begin(), roles.end(), role);
    const auto* const found_better = std::find(betters.begin(), betters.end(), better);
    if (found_role == roles.end()) {
        fields.fail("role", "group, name or measured");
        return;
    }
    if (found_better == betters.end()) {
        fields.fail("better", "less or more");
        return;
    }
    column.role = static_cast<FigureColumn::Role>(found_role - roles.begin());
    column.better = static_cast<FigureColumn::Better>(found_better - betters.begin());
}

namespace {

// The values of a row at the columns; `place` is its own. Sets the document's error if one cannot
// be compared.
FigureJson values_of(JsonReader& document, const json& row, const std::string& place,
                     const std::vector<FigureColumn>& columns) {
    FigureJson values = FigureJson::array();
    for (const FigureColumn& column : columns) {
        const json::json_pointer pointer(column.key);
        const json value = row.contains(pointer) ? row.at(pointer) : json();
        if (column.better != FigureColumn::Better::none && !is_number_or_absent(value)) {
            document.fail_at(place + column.key, value, "a number");
        }
        values.push_back(FigureJson(value));
    }
    return values;
}

Result<Document> joined(std::vector<FigureTable> parts) {
    auto run = whole_run(std::move(parts));
    if (!run) {
        return run.error();
    }
    FigureTable all = std::move(run->front());
    all.shard = {};
    for (std::size_t i = 1; i < run->size(); ++i) {
        FigureTable& part = (*run)[i];
        const bool is_same =
            part.suite == all.suite &&
            std::equal(part.columns.begin(), part.columns.end(), all.columns.begin(),
                       all.columns.end(),
                       [](const auto& a, const auto& b) { return a.key == b.key; });
        if (!is_same) {
            return Error{"parts with different columns found, the same were expected"};
        }
        std::move(part.rows.begin(), part.rows.end(), std::back_inserter(all.rows));
        all.end.stopped = all.end.stopped ? all.end.stopped : part.end.stopped;
    }
    return Document(std::move(all));
}

} // namespace

FigureTable read_figures(JsonReader& document) {
    FigureTable table;
    ReportHead head = read_head(document);
    table.suite = std::move(head.suite);
    table.environment = std::move(head.environment);
    table.shard = head.shard;
    table.notes = std::move(head.notes);
    table.end.stopped = std::move(head.stopped);
    table.settings = FigureJson(document.value("settings"));
    table.summary = FigureJson(document.value("summary"));
    document.array("columns", table.columns);
    if (!table.settings.is_object()) {
        document.fail("settings", "an object");
    }
    if (table.columns.empty()) {
        document.fail("columns", "some columns");
        return table;
    }
    if (const auto wrong = misplaced_column(table.columns)) {
        document.fail_at(fmt::format("columns[{}].key", *wrong), table.columns[*wrong].key,
                         "a place in a row besides those of other columns");
        return table;
    }
    const json& rows = document.value("rows");
    if (!rows.is_array()) {
        document.fail("rows", "an array of objects");
        return table;
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const std::string place = fmt::format("rows[{}]", i);
        if (!rows[i].is_object()) {
            document.fail_at(place, rows[i], "an object");
            return table;
        }
        table.rows.push_back(values_of(document, rows[i], place, table.columns));
    }
    return table;
}

std::string suite_of(const Document& document) {
    if (const auto* const table = std::get_if<FigureTable>(&document)) {
        return table->suite;
    }
    const std::vector<Row>& rows = std::get<Results>(document).rows;
    return rows.empty() ? "" : rows.front().suite;
}

Result<Document> read_document(const std::filesystem::path& file) {
    Document document;
    const auto done = read_report(file, [&](JsonReader& fields) {
        if (fields.has("columns")) {
            document = read_figures(fields);
        } else {
            document = read_results(fields);
        }
    });
    return done ? Result<Document>(std::move(document)) : done.error();
}

static Result<FigureTable> read_table(const std::filesystem::path& file) {
    auto part = read_document(file);
    if (!part) {
        return part.error();
    }
    auto* const table = std::get_if<FigureTable>(&*part);
    return table != nullptr
               ? Result<FigureTable>(std::move(*table))
               : Error{fmt::format("{}: no columns found, some were expected", file.string())};
}

Result<Document> read_document_parts(const std::filesystem::path& name) {
    if (!names_parts(name)) {
        return read_document(name);
    }
    const auto first = read_document(part_file(name, {0, 1}));
    if (!first) {
        return first.error();
    }
    if (std::holds_alternative<Results>(*first)) {
        auto results = read_result_parts(name);
        return results ? Result<Document>(Document(std::move(*results))) : results.error();
    }
    auto parts = read_parts(name, read_table);
    if (!parts) {
        return parts.error();
    }
    auto all = joined(std::move(*parts));
    return all ? std::move(all) : Error{fmt::format("{}: {}", name.string(), all.error().message)};
}

} // namespace reljef::bench
