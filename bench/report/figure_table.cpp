#include "bench/report/figure_table.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "bench/report/report_json.h"

namespace reljef::bench {
namespace {

const char* role_word(FigureColumn::Role role) {
    return role == FigureColumn::Role::group  ? "group"
           : role == FigureColumn::Role::name ? "name"
                                              : "measured";
}

FigureJson column_json(const FigureColumn& column) {
    FigureJson json{
        {"key", column.key}, {"heading", column.heading}, {"role", role_word(column.role)}};
    const auto add = [&](const char* key, const std::string& text) {
        if (!text.empty()) {
            json[key] = text;
        }
    };
    add("unit", column.unit);
    if (column.better != FigureColumn::Better::none) {
        json["better"] = column.better == FigureColumn::Better::less ? "less" : "more";
    }
    add("noise", column.noise);
    add("limit", column.limit);
    if (column.is_detail) {
        json["detail"] = true;
    }
    return json;
}

FigureJson row_object(const FigureTable& table, const FigureJson& row) {
    FigureJson object = FigureJson::object();
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const FigureJson::json_pointer pointer(table.columns[i].key);
        const FigureJson& value = row.at(i);
        const bool is_infinite = value.is_number_float() && !std::isfinite(value.get<double>());
        if (!value.is_null()) {
            object[pointer] = is_infinite ? FigureJson() : value;
        } else if (const auto parent = pointer.parent_pointer(); parent.empty()) {
            object[pointer] = nullptr;
        } else if (!object.contains(parent)) {
            object[parent] = nullptr;
        }
    }
    return object;
}

} // namespace

namespace columns {

FigureColumn group(std::string key, std::string heading) {
    return {.key = std::move(key),
            .heading = std::move(heading),
            .unit = {},
            .role = FigureColumn::Role::group};
}

FigureColumn name(std::string key, std::string heading) {
    return {.key = std::move(key),
            .heading = std::move(heading),
            .unit = {},
            .role = FigureColumn::Role::name};
}

FigureColumn plain(std::string key, std::string heading, std::string unit, int decimals) {
    return {.key = std::move(key),
            .heading = std::move(heading),
            .unit = std::move(unit),
            .role = FigureColumn::Role::measured,
            .better = FigureColumn::Better::none,
            .decimals = decimals};
}

FigureColumn less(std::string key, std::string heading, std::string unit, int decimals) {
    FigureColumn column = plain(std::move(key), std::move(heading), std::move(unit), decimals);
    column.better = FigureColumn::Better::less;
    return column;
}

FigureColumn more(std::string key, std::string heading, std::string unit, int decimals) {
    FigureColumn column = plain(std::move(key), std::move(heading), std::move(unit), decimals);
    column.better = FigureColumn::Better::more;
    return column;
}

FigureColumn detail(FigureColumn column) {
    column.is_detail = true;
    return column;
}

} // namespace columns

RunEnd run_end(const Result<void>& done, const std::stop_token& stop, bool has_rows) {
    if (stop.stop_requested()) {
        return {Error{has_rows ? "interrupted, the table holds what was measured until then"
                               : "interrupted before anything was measured"},
                false};
    }
    return done ? RunEnd{} : RunEnd{done.error(), true};
}

std::string size_text(glm::ivec2 size) {
    return fmt::format("{}x{}", size.x, size.y);
}

std::string figure_json(const FigureTable& table) {
    FigureJson json = json_of(ReportHead{.suite = table.suite,
                                         .complete = !table.end.stopped.has_value(),
                                         .stopped = table.end.stopped,
                                         .notes = table.notes,
                                         .environment = table.environment,
                                         .shard = table.shard});
    json["settings"] = table.settings;
    if (!table.summary.is_null()) {
        json["summary"] = table.summary;
    }
    json["columns"] = FigureJson::array();
    for (const FigureColumn& column : table.columns) {
        json["columns"].push_back(column_json(column));
    }
    json["rows"] = FigureJson::array();
    for (const FigureJson& row : table.rows) {
        json["rows"].push_back(row_object(table, row));
    }
    // File names need not be UTF-8.
    return json.dump(2, ' ', false, FigureJson::error_handler_t::replace) + "\n";
}

} // namespace reljef::bench
