#pragma once

#include <string>

#include "bench/report/results.h"

namespace reljef::bench {

/// The rows as a table for people, with what they were measured on. UTF-8, lines end in '\n'.
/// Precondition: there is a row.
std::string terminal_report(const Results& results);

} // namespace reljef::bench
