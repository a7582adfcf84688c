#include "bench/report/report_text.h"

#include <fmt/format.h>

#include "bench/report/report_table.h"

namespace reljef::bench {
namespace {

std::string markdown_table(const ReportTable& table) {
    std::string text =
        fmt::format("## {}\n\n{}{}", markdown_escaped(table.heading), markdown_line(table.columns),
                    markdown_rule(table.columns.size()));
    for (const auto& line : table.lines) {
        text += markdown_line(line);
    }
    for (const std::string& note : table.notes) {
        text += fmt::format("\n{}\n", markdown_escaped(note));
    }
    return text + "\n";
}

std::string markdown_front(const Front& front) {
    std::string text = fmt::format("- {}, {}: {}; {}\n", markdown_escaped(front.scene),
                                   scene::to_string(front.pose),
                                   markdown_escaped(front_text(front)), area_text(front));
    if (!front.holed.empty()) {
        text += fmt::format("  - {}\n", markdown_escaped(holed_text(front)));
    }
    for (const Front::Dominated& setting : front.dominated) {
        text += fmt::format("  - {} is dominated by {}\n", markdown_escaped(setting.label),
                            markdown_escaped(setting.by));
    }
    return text;
}

std::string markdown_list(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) {
        text += fmt::format("- {}\n", markdown_escaped(line));
    }
    return text + "\n";
}

} // namespace

std::string markdown_escaped(std::string_view text) {
    constexpr std::string_view markup = "\\`*_{}[]<>#|~&!";
    std::string result;
    for (const char c : text) {
        if (markup.find(c) != std::string_view::npos) {
            result += '\\';
        }
        result += c == '\n' || c == '\r' ? ' ' : c;
    }
    return result;
}

std::string markdown_line(const std::vector<std::string>& cells) {
    std::string line = "|";
    for (const std::string& cell : cells) {
        line += fmt::format(" {} |", markdown_escaped(cell));
    }
    return line + "\n";
}

std::string markdown_report(const Results& raw) {
    check(!raw.rows.empty(), "a report of no rows");
    const Results results = printable(raw);
    std::string text = fmt::format("# reljef-bench {}\n\n", results.rows.front().suite) +
                       markdown_list(environment_lines(results));
    for (const ReportTable& table : report_tables(results)) {
        text += markdown_table(table);
    }
    if (!results.fronts.empty()) {
        text += "## Pareto fronts\n\n";
        for (const Front& front : results.fronts) {
            text += markdown_front(front);
        }
        text += "\n";
    }
    if (results.stopped) {
        text += fmt::format("Ended early: {}\n\n", markdown_escaped(results.stopped->message));
    }
    return text + markdown_list(column_notes(results));
}

} // namespace reljef::bench
