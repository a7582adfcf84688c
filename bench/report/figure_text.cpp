// Tables of rows with columns for a terminal, Markdown and CSV.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/cli/message.h"
#include "bench/report/figure_table.h"
#include "bench/report/report_table.h"

namespace reljef::bench {
namespace {

constexpr double bytes_a_megabyte = 1e6;
constexpr std::string_view bytes_unit = "bytes";

std::string plain_dump(const FigureJson& value) {
    return value.dump(-1, ' ', false, FigureJson::error_handler_t::replace);
}

std::string cell_text(const FigureJson& value, const FigureColumn& column) {
    if (value.is_null()) {
        return "–";
    }
    if (value.is_number() && column.unit == bytes_unit) {
        return fmt::format("{:.{}f}", value.get<double>() / bytes_a_megabyte, column.decimals);
    }
    if (value.is_number_float() && !std::isfinite(value.get<double>())) {
        return std::isnan(value.get<double>()) ? "–" : "∞";
    }
    if (value.is_number_float()) {
        return fmt::format("{:.{}f}", value.get<double>(), column.decimals);
    }
    return value.is_string() ? cli::printable(value.get<std::string>()) : plain_dump(value);
}

// Rows with equal values of the group columns.
struct FigureGroup {
    std::string title; // these values; empty: there is no such column
    std::vector<std::size_t> rows;
};

std::vector<FigureGroup> groups_of(const FigureTable& table) {
    std::vector<FigureGroup> groups;
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        std::vector<std::string> words;
        for (std::size_t i = 0; i < table.columns.size(); ++i) {
            const FigureJson& value = table.rows[row].at(i);
            if (table.columns[i].role == FigureColumn::Role::group && !value.is_null()) {
                words.push_back(cell_text(value, table.columns[i]));
            }
        }
        std::string title = fmt::format("{}", fmt::join(words, ", "));
        auto group = std::find_if(groups.begin(), groups.end(),
                                  [&](const FigureGroup& each) { return each.title == title; });
        if (group == groups.end()) {
            group = groups.insert(groups.end(), FigureGroup{std::move(title), {}});
        }
        group->rows.push_back(row);
    }
    return groups;
}

// The indices of the columns that a table of these rows shows.
std::vector<std::size_t> shown_columns(const FigureTable& table, const FigureGroup& group) {
    std::vector<std::size_t> shown;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const FigureColumn& column = table.columns[i];
        const bool has_value = std::any_of(group.rows.begin(), group.rows.end(), [&](auto row) {
            return !table.rows[row].at(i).is_null();
        });
        if (has_value && !column.is_detail && column.role != FigureColumn::Role::group) {
            shown.push_back(i);
        }
    }
    return shown;
}

using Lines = std::vector<std::vector<std::string>>;

// The heading and the rows; of a single row in all of the table, a line for each figure.
Lines lines_of(const FigureTable& table, const FigureGroup& group) {
    const std::vector<std::size_t> shown = shown_columns(table, group);
    Lines lines(1);
    for (const std::size_t column : shown) {
        lines[0].push_back(heading_text(table.columns[column]));
    }
    for (const std::size_t row : group.rows) {
        lines.emplace_back();
        for (const std::size_t column : shown) {
            lines.back().push_back(cell_text(table.rows[row].at(column), table.columns[column]));
        }
    }
    if (table.rows.size() != 1) {
        return lines;
    }
    Lines turned{{"figure", "value"}};
    for (std::size_t i = 0; i < shown.size(); ++i) {
        turned.push_back({lines[0][i], lines[1][i]});
    }
    return turned;
}

// "size 1024x768"; empty: nothing was said.
std::string setting_text(const std::string& key, const FigureJson& value) {
    if (value.is_null() || value == false || (value.is_array() && value.empty())) {
        return "";
    }
    if (value.is_array()) {
        std::vector<std::string> words;
        for (const FigureJson& each : value) {
            words.push_back(cell_text(each, {}));
        }
        return fmt::format("{} {}", key, fmt::join(words, " "));
    }
    const std::string text = value.is_number() ? plain_dump(value) : cell_text(value, {});
    return value == true ? key : fmt::format("{} {}", key, text);
}

std::string settings_text(const FigureTable& table) {
    std::vector<std::string> texts;
    for (const auto& [key, value] : table.settings.items()) {
        if (std::string text = setting_text(key, value); !text.empty()) {
            texts.push_back(std::move(text));
        }
    }
    return fmt::format("{}", fmt::join(texts, ", "));
}

} // namespace

std::string heading_text(const FigureColumn& column) {
    const std::string unit = column.unit == bytes_unit ? "MB" : column.unit;
    return cli::printable(unit.empty() ? column.heading
                                       : fmt::format("{} {}", column.heading, unit));
}

std::string figure_text(const FigureTable& table) {
    std::vector<std::pair<std::string, Lines>> tables;
    for (const FigureGroup& group : groups_of(table)) {
        tables.emplace_back(group.title, lines_of(table, group));
    }
    std::string text =
        fmt::format("{}: {}\n{}, {} thread{}\n", table.suite, settings_text(table),
                    cli::printable(table.environment.renderer), table.environment.threads,
                    table.environment.threads == 1 ? "" : "s");
    for (const auto& [title, lines] : tables) {
        text += title.empty() ? "\n" : fmt::format("\n{}\n", title);
        const std::vector<std::size_t> widths = column_widths(lines);
        for (const auto& line : lines) {
            text += line.empty() ? "" : padded_line(line, widths);
        }
    }
    text += table.notes.empty() ? "" : "\n";
    for (const std::string& note : table.notes) {
        text += cli::printable(note) + "\n";
    }
    return text;
}

std::string figure_markdown(const FigureTable& table) {
    const Environment& environment = table.environment;
    std::string text = fmt::format("# reljef-bench {}\n\n", table.suite);
    for (const std::string& line :
         {settings_text(table), "renderer: " + environment.renderer,
          fmt::format("machine: {}, {} thread{}; commit {}", environment.cpu, environment.threads,
                      environment.threads == 1 ? "" : "s", environment.commit)}) {
        text += line.empty() ? "" : fmt::format("- {}\n", markdown_escaped(line));
    }
    for (const FigureGroup& group : groups_of(table)) {
        text +=
            group.title.empty() ? "\n" : fmt::format("\n## {}\n\n", markdown_escaped(group.title));
        const Lines lines = lines_of(table, group);
        for (std::size_t i = 0; i < lines.size(); ++i) {
            text += markdown_line(lines[i]);
            text += i == 0 ? markdown_rule(lines[i].size()) : "";
        }
    }
    for (const std::string& note : table.notes) {
        text += fmt::format("\n{}\n", markdown_escaped(cli::printable(note)));
    }
    if (table.end.stopped) {
        text += fmt::format("\nEnded early: {}\n",
                            markdown_escaped(in_one_line(table.end.stopped->message)));
    }
    return text;
}

std::string in_one_line(const std::string& lines) {
    std::string line;
    for (const char letter : lines) {
        line += letter == '\n' ? std::string("; ") : std::string(1, letter);
    }
    return line;
}

std::string figure_csv(const FigureTable& table) {
    std::vector<std::string> cells;
    for (const FigureColumn& column : table.columns) {
        std::string key = column.key.substr(1);
        std::replace(key.begin(), key.end(), '/', '.');
        cells.push_back(csv_quoted(key));
    }
    std::string text = fmt::format("{}\n", fmt::join(cells, ","));
    for (const FigureJson& row : table.rows) {
        cells.clear();
        for (const FigureJson& value : row) {
            const bool is_absent =
                value.is_null() || (value.is_number_float() && !std::isfinite(value.get<double>()));
            cells.push_back(is_absent ? ""
                                      : csv_quoted(value.is_string() ? value.get<std::string>()
                                                                     : plain_dump(value)));
        }
        text += fmt::format("{}\n", fmt::join(cells, ","));
    }
    return text;
}

} // namespace reljef::bench
