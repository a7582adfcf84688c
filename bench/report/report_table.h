#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bench/report/results.h"

namespace reljef::bench {

/// The rows of one test, scene, pose and size as text cells (UTF-8).
struct ReportTable {
    std::string heading;
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> lines; ///< one cell for each column
    std::vector<std::string> notes;
};

/// One table for each sequence of rows with the same test, scene, pose and size. The heading shows
/// the noise floor in place of null rows.
std::vector<ReportTable> report_tables(const Results& results);

/// The results with printable names, see cli::printable().
Results printable(Results results);

/// The environment as lines "renderer: …".
std::vector<std::string> environment_lines(const Results& results);

/// Sentences that explain the columns.
std::vector<std::string> column_notes(const Results& results);

/// The labels of a front, or "none".
std::string front_text(const Front& front);

/// "area 0.250", or why there is none.
std::string area_text(const Front& front);

/// The rows with too many holes.
std::string holed_text(const Front& front);

/// A cell of CSV, in quotes if it needs them (RFC 4180).
std::string csv_quoted(const std::string& text);

/// Text that Markdown shows as it is, in one line.
std::string markdown_escaped(std::string_view text);
/// A line of a Markdown table.
std::string markdown_line(const std::vector<std::string>& cells);

/// The line below a heading of a Markdown table: the first column aligned left, the others right.
std::string markdown_rule(std::size_t columns);

/// Number of code points.
std::size_t text_width(const std::string& text);

/// Widths of columns that hold all cells, in code points.
std::vector<std::size_t> column_widths(const std::vector<std::vector<std::string>>& lines);

/// The cells padded to `widths`: the first aligned left, the others right.
std::string padded_line(const std::vector<std::string>& cells,
                        const std::vector<std::size_t>& widths);

} // namespace reljef::bench
