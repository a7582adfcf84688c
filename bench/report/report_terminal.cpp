#include "bench/report/report_text.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bench/report/report_table.h"

namespace reljef::bench {
namespace {

constexpr std::size_t screen_columns = 100;

// A line broken between words where it would leave the screen; what follows is indented. A word
// that is wider than the screen stays whole.
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

std::vector<std::size_t> widths_of(const std::vector<ReportTable>& tables) {
    std::vector<std::size_t> widths;
    const auto widen = [&](const std::vector<std::string>& cells) {
        widths.resize(std::max(widths.size(), cells.size()));
        for (std::size_t i = 0; i < cells.size(); ++i) {
            widths[i] = std::max(widths[i], text_width(cells[i]));
        }
    };
    for (const ReportTable& table : tables) {
        widen(table.columns);
        std::for_each(table.lines.begin(), table.lines.end(), widen);
    }
    return widths;
}

std::string padded_line(const std::vector<std::string>& cells,
                        const std::vector<std::size_t>& widths) {
    std::string line;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const std::string padding(widths[i] - text_width(cells[i]), ' ');
        line += i == 0 ? cells[i] + padding : "  " + padding + cells[i];
    }
    return line + "\n";
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
                    fmt::join(environment_lines(results.environment), "\n"));
    for (const ReportTable& table : tables) {
        text += terminal_table(table, widths_of(tables));
    }
    text += terminal_fronts(results.fronts);
    for (const std::string& note : column_notes(results)) {
        text += wrapped(note);
    }
    return text;
}

} // namespace reljef::bench
