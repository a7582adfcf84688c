#include "bench/report_terminal.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace reljef::bench {
namespace {

constexpr std::size_t columns = 9;
constexpr std::size_t left_aligned_columns = 2;
constexpr std::size_t reliable_frames = 5;
using Cells = std::array<std::string, columns>;

std::size_t code_points(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
    }));
}

// 1234567 as "1,234,567".
std::string grouped(std::size_t number) {
    std::string text = std::to_string(number);
    for (std::size_t from_end = 3; from_end < text.size(); from_end += 4) {
        text.insert(text.size() - from_end, ",");
    }
    return text;
}

std::string name_of(const Row& row) {
    return row.null_row ? fmt::format("{} (again)", scene::to_string(row.technique))
                        : scene::to_string(row.technique);
}

std::string milliseconds(double value, int decimals) {
    return fmt::format("{:.{}f}", value, decimals);
}

Cells cells_of(const Row& row, int decimals) {
    return {row.scene,
            name_of(row),
            milliseconds(row.ms.median, decimals),
            milliseconds(row.ms.p95, decimals),
            fmt::format("{:.1f}", 1000.0 / row.ms.median),
            fmt::format("{:.2f}", row.ratio_to_texture),
            grouped(row.stats.triangles),
            std::to_string(row.frames),
            row.noise_floor ? fmt::format("{:.1f} %", 100.0 * *row.noise_floor) : "?"};
}

std::string line_of(const Cells& cells, const std::array<std::size_t, columns>& widths) {
    std::string line;
    for (std::size_t i = 0; i < columns; ++i) {
        const std::string padding(widths[i] - code_points(cells[i]), ' ');
        line += i == 0 ? "" : "  ";
        line += i < left_aligned_columns ? cells[i] + padding : padding + cells[i];
    }
    return line + "\n";
}

std::string table_of(const std::vector<Row>& rows) {
    const bool is_fast =
        std::any_of(rows.begin(), rows.end(), [](const Row& row) { return row.ms.median < 1.0; });
    std::vector<Cells> lines{{"scene", "technique", "median ms", "p95 ms", "fps", "ratio",
                              "triangles", "frames", "noise floor"}};
    std::transform(rows.begin(), rows.end(), std::back_inserter(lines),
                   [&](const Row& row) { return cells_of(row, is_fast ? 3 : 2); });
    std::array<std::size_t, columns> widths{};
    for (const Cells& cells : lines) {
        for (std::size_t i = 0; i < columns; ++i) {
            widths[i] = std::max(widths[i], code_points(cells[i]));
        }
    }
    std::string table;
    for (const Cells& cells : lines) {
        table += line_of(cells, widths);
    }
    return table;
}

std::string heading_of(const Row& row, const Environment& environment) {
    return fmt::format("{}: {}x{} pixels, pose {}, frames of the techniques interleaved\n"
                       "renderer: {}\n"
                       "OpenGL:   {}, context {}\n"
                       "machine:  {}, {} thread{}; commit {}\n",
                       row.suite, row.size.x, row.size.y, scene::to_string(row.pose),
                       environment.renderer, environment.gl, environment.context, environment.cpu,
                       environment.threads, environment.threads == 1 ? "" : "s",
                       environment.commit);
}

std::string warning_of(const std::vector<Row>& rows) {
    const bool too_few = std::any_of(rows.begin(), rows.end(),
                                     [](const Row& row) { return row.frames < reliable_frames; });
    return too_few
               ? fmt::format("Caution: under {} frames of a technique are too few to rely on.\n",
                             reliable_frames)
               : "";
}

} // namespace

std::string terminal_report(const Results& results) {
    check(!results.rows.empty(), "a report of no rows");
    return heading_of(results.rows.front(), results.environment) + "\n" + table_of(results.rows) +
           "\n"
           "ratio: median over the median of texture on the same scene in the same run.\n"
           "noise floor: how far two measurements of texture in one run lie apart; a difference "
           "below it\nis none.\n"
           "error: not told; a column for it comes with the truth, the exact picture to compare "
           "with.\n" +
           warning_of(results.rows);
}

} // namespace reljef::bench
