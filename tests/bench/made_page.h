#pragma once

#include <string>
#include <vector>

#include "bench/page.h"

namespace reljef::test {

/// A report of the schema "reljef-bench/1" as a page gets it: the table relief-4 on `natural` with
/// a missing, a noisy and a null row and an exact picture, and relief-3 on `scene`.
std::string made_report(const std::string& scene = "urban");

/// The same with a Pareto front on `natural` in place of the tables.
std::string made_pareto_report();

/// Pictures of the first three rows of made_report(): a gradient, a darker one that all three
/// share, and a heat map with a hatch and an error without a bound.
std::vector<bench::RowPictures> made_pictures(int cols = 64, int rows = 48);

} // namespace reljef::test
