#include "bench/report/figure_table.h"

#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/cli/message.h"
#include "bench/report/report_table.h"
#include "engine/core/atomic_file.h"

namespace reljef::bench {
namespace {

FigureJson row_object(const FigureTable& table, const FigureJson& row) {
    FigureJson object = FigureJson::object();
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        if (table.columns[i].pointer.empty()) {
            continue;
        }
        const FigureJson::json_pointer pointer(table.columns[i].pointer);
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

std::string cell_text(const FigureJson& value, int decimals) {
    if (value.is_null()) {
        return "–";
    }
    if (value.is_number_float()) {
        return fmt::format("{:.{}f}", value.get<double>(), decimals);
    }
    return value.is_string() ? cli::printable(value.get<std::string>())
                             : value.dump(-1, ' ', false, FigureJson::error_handler_t::replace);
}

std::vector<std::vector<std::string>> lines_of(const FigureTable& table) {
    std::vector<std::vector<std::string>> lines(1 + table.rows.size());
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const FigureColumn& column = table.columns[i];
        if (column.heading.empty()) {
            continue;
        }
        lines[0].push_back(column.heading);
        for (std::size_t row = 0; row < table.rows.size(); ++row) {
            lines[row + 1].push_back(cell_text(table.rows[row].at(i), column.decimals));
        }
    }
    return lines;
}

} // namespace

std::string size_text(glm::ivec2 size) {
    return fmt::format("{}x{}", size.x, size.y);
}

RunEnd run_end(const Result<void>& done, const std::stop_token& stop, bool has_rows) {
    if (stop.stop_requested()) {
        return {Error{has_rows ? "interrupted, the table holds what was measured until then"
                               : "interrupted before anything was measured"},
                false};
    }
    return done ? RunEnd{} : RunEnd{done.error(), true};
}

FigureJson json_of(const Summary& summary) {
    return {{"median", summary.median}, {"p95", summary.p95}, {"p99", summary.p99}};
}

std::string figure_json(const FigureTable& table) {
    FigureJson json{{"schema", table.schema},
                    {"complete", !table.end.stopped.has_value()},
                    {"stopped", nullptr}};
    if (table.end.stopped) {
        json["stopped"] = table.end.stopped->message;
    }
    json.update(table.settings);
    if (!table.columns.empty()) {
        json["rows"] = FigureJson::array();
        for (const FigureJson& row : table.rows) {
            json["rows"].push_back(row_object(table, row));
        }
    }
    // File names need not be UTF-8.
    return json.dump(2, ' ', false, FigureJson::error_handler_t::replace) + "\n";
}

std::string figure_text(const FigureTable& table) {
    const auto lines = lines_of(table);
    const std::vector<std::size_t> widths = column_widths(lines);
    std::string text = table.heading + "\n";
    for (const auto& line : lines) {
        text += line.empty() ? "" : padded_line(line, widths);
    }
    return text + table.summary;
}

std::string figure_markdown(const FigureTable& table) {
    std::string text = table.heading + "\n\n";
    const auto lines = lines_of(table);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        text += fmt::format("| {} |\n", fmt::join(lines[i], " | "));
        text += i == 0 ? markdown_rule(lines[i].size()) : "";
    }
    return text + "\n" + table.summary;
}

Result<void> report(const FigureTable& table, const std::filesystem::path& json,
                    const std::filesystem::path& markdown) {
    if (!table.columns.empty() && table.rows.empty()) {
        return table.end.stopped.value_or(Error{"no rows found, some were expected"});
    }
    Result<void> written;
    if (!table.end.failed && !json.empty()) {
        written = write_text_file(json, figure_json(table));
    }
    if (written && !table.end.failed && !markdown.empty()) {
        written = write_text_file(markdown, figure_markdown(table));
    }
    fmt::print("{}", figure_text(table));
    if (std::fflush(stdout) != 0 || !written) {
        return written;
    }
    return table.end.stopped ? Result<void>(*table.end.stopped) : Result<void>();
}

} // namespace reljef::bench
