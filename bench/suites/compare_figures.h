#pragma once

#include "bench/report/figure_table.h"
#include "bench/suites/compare.h"

namespace reljef::bench {

/// Compares runs `a` and `b` of one suite row by row. Rows match by the values of their group and
/// name columns; of equal rows the first matches the first, and so on. Columns that are better or
/// worse are compared, as `a` describes them.
///
/// A figure changed if it differs by more than `threshold` (a share, >= 0) and by more than the
/// noise floors of both rows. If its column has a noise floor and a row has none, there is no
/// verdict: it is `untimed`. A figure within its limit in both runs is the same. Times (ms, s) of
/// different environments are not compared. Each setting that differs is a note. A missing or
/// infinite figure is worse than any; if neither run has one, nothing is compared.
Comparison compare(const FigureTable& a, const FigureTable& b, double threshold = 0.10);

} // namespace reljef::bench
