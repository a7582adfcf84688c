#pragma once

#include <string>

#include "bench/report/results.h"

namespace reljef::bench {

/// One line for each row, null rows too, below a line of names that state the units (RFC 4180, but
/// lines end in '\n'). Missing figures are empty.
std::string csv_report(const Results& results);

/// Tables in GitHub's Markdown with the environment. Names are escaped.
std::string markdown_report(const Results& results);

/// Tables for a terminal with the environment, UTF-8. Precondition: at least one row.
std::string terminal_report(const Results& results);

} // namespace reljef::bench
