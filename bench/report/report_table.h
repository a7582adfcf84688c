#pragma once

#include <string>
#include <vector>

#include "bench/report/results.h"

namespace reljef::bench {

/// The rows of one scene and pose as cells of text, UTF-8; the first column reads from the left,
/// the others are numbers.
struct ReportTable {
    std::string heading;
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> lines; ///< as many cells as columns
    std::vector<std::string> notes;
};

/// One table for each run of rows with one test, scene, pose and size. Null rows are no lines: the
/// heading tells the noise floor. Columns for the sources' figures only where there are some.
std::vector<ReportTable> report_tables(const Results& results);

/// The results with every name as a terminal may show it, see cli::printable().
Results printable(Results results);

/// On what it was measured, as lines "renderer: …".
std::vector<std::string> environment_lines(const Environment& environment);

/// What the columns mean, as sentences.
std::vector<std::string> column_notes(const Results& results);

/// The labels of a front, the fastest first, or that there is none.
std::string front_text(const Front& front);

/// "area 0.250", or that there is none.
std::string area_text(const Front& front);

/// Which rows have too many holes for the front.
std::string holed_text(const Front& front);

/// The number of code points.
std::size_t text_width(const std::string& text);

} // namespace reljef::bench
