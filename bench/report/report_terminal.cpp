#include "bench/report/report_text.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bench/report/report_table.h"

namespace reljef::bench {
namespace {

constexpr std::size_t screen_columns = 100;

// Breaks a line between words at the screen's width and indents the rest. Wider words stay whole.
std::string wrapped(const std::string& line, std::size_t indent = 2) {
    std::string text;
    std::string current;
    for (std::size_t begin = 0; begin <= line.size();) {
        const std::size_t end = std::min(line.find(' ', begin), line.size());
        const std::string word = line.substr(begin, end - begin);
        if (begin > 0 && text_width(current) + 1 + text_width(word) > screen_columns) {
            text += current + "\n";
            current = std::string(indent, ' ') + word;
        } else {
            current += (begin > 0 ? " " : "") + word;
        }
        begin = end + 1;
    }
    return text + current + "\n";
}

std::string terminal_table(const ReportTable& table, const std::vector<std::size_t>& widths) {
    std::string text = table.heading + "\n" + padded_line(table.columns, widths);
    for (const auto& line : table.lines) {
        text += padded_line(line, widths);
    }
    for (const std::string& note : table.notes) {
        text += wrapped(note);
    }
    return text + "\n";
}

std::string terminal_front(const Front& front) {
    std::string text =
        wrapped(fmt::format("{}, {}: front {}; {}", front.scene, scene::to_string(front.pose),
                            front_text(front), area_text(front)));
    if (!front.holed.empty()) {
        text += wrapped("  " + holed_text(front), 4);
    }
    for (const Front::Dominated& setting : front.dominated) {
        text += wrapped(fmt::format("  {} is dominated by {}", setting.label, setting.by), 4);
    }
    return text;
}

std::string terminal_fronts(const std::vector<Front>& fronts) {
    if (fronts.empty()) {
        return "";
    }
    std::string text = "Pareto fronts of ratio to texture against error px, fastest first; the "
                       "smaller the area,\nthe better:\n";
    for (const Front& front : fronts) {
        text += terminal_front(front);
    }
    return text + "\n";
}

} // namespace

std::string terminal_report(const Results& raw) {
    check(!raw.rows.empty(), "a report of no rows");
    const Results results = printable(raw);
    const std::vector<ReportTable> tables = report_tables(results);
    std::string text =
        fmt::format("{}: frames of the techniques interleaved\n{}\n\n", results.rows.front().suite,
                    fmt::join(environment_lines(results), "\n"));
    std::vector<std::vector<std::string>> lines;
    for (const ReportTable& table : tables) {
        lines.push_back(table.columns);
        lines.insert(lines.end(), table.lines.begin(), table.lines.end());
    }
    const std::vector<std::size_t> widths = column_widths(lines);
    for (const ReportTable& table : tables) {
        text += terminal_table(table, widths);
    }
    text += terminal_fronts(results.fronts);
    for (const std::string& note : column_notes(results)) {
        text += wrapped(note);
    }
    return text;
}

} // namespace reljef::bench
