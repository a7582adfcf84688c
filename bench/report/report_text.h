#pragma once

#include <string>

#include "bench/report/results.h"

namespace reljef::bench {

/// A heading with units and one line for each row, including null rows (RFC 4180, but lines end in
/// '\n'). Absent figures are empty.
std::string csv_report(const Results& results);

/// The environment and tables as GitHub Markdown. Precondition: at least one row.
std::string markdown_report(const Results& results);

/// The environment and tables for a terminal, UTF-8. Precondition: at least one row.
std::string terminal_report(const Results& results);

} // namespace reljef::bench
