#include "bench/report_terminal.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bench/report_table.h"

namespace reljef::bench {
namespace {

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
        text += note + "\n";
    }
    return text + "\n";
}

std::string terminal_front(const Front& front) {
    std::string text =
        fmt::format("{}, {}: front {}; area {:.3f}\n", front.scene, scene::to_string(front.pose),
                    fmt::join(front.front, ", "), front.area);
    for (const Front::Dominated& setting : front.dominated) {
        text += fmt::format("  {} is dominated by {}\n", setting.label, setting.by);
    }
    return text;
}

std::string terminal_fronts(const std::vector<Front>& fronts) {
    if (fronts.empty()) {
        return "";
    }
    std::string text = "Pareto fronts of ratio to texture against error px, fastest first; the "
                       "smaller the area the\nbetter:\n";
    for (const Front& front : fronts) {
        text += terminal_front(front);
    }
    return text + "\n";
}

} // namespace

std::string terminal_report(const Results& results) {
    check(!results.rows.empty(), "a report of no rows");
    const std::vector<ReportTable> tables = report_tables(results);
    std::string text =
        fmt::format("{}: frames of the techniques interleaved\n{}\n\n", results.rows.front().suite,
                    fmt::join(environment_lines(results.environment), "\n"));
    for (const ReportTable& table : tables) {
        text += terminal_table(table, widths_of(tables));
    }
    return text + terminal_fronts(results.fronts) +
           fmt::format("{}\n", fmt::join(column_notes(results), "\n"));
}

} // namespace reljef::bench
