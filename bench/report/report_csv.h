#pragma once

#include <string>

#include "bench/report/results.h"

namespace reljef::bench {

/// One line a row, null rows too, below a line of names (RFC 4180, but lines end in '\n'). Units
/// are in the names; what there is no figure of is empty.
std::string csv_report(const Results& results);

} // namespace reljef::bench
