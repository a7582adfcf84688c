#pragma once

#include <string>

#include "bench/report/results.h"

namespace reljef::test {

/// The table relief-4 on `natural` with a null row, exact pictures and one of them with pixels
/// without a bound; relief-3 on `scene` with a noisy row, one of few frames and one that shows
/// nothing; a note.
bench::Results made_report(const std::string& scene = "urban");

/// The same with a Pareto front on `natural` in place of the tables, settings left out.
bench::Results made_pareto_report();

/// Adds pictures of the first three rows: a gradient, a darker one that all three share, and a heat
/// map with a hatch and an error without a bound.
bench::Results with_pictures(bench::Results results, int cols = 64, int rows = 48);

} // namespace reljef::test
