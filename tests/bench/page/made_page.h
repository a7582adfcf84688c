#pragma once

#include <string>
#include <vector>

#include "bench/page/page.h"

namespace reljef::test {

/// A report as a page gets it, from json_report(): the table relief-4 on `natural` with a missing
/// and a null row, exact pictures and one of them with pixels without a bound; relief-3 on `scene`
/// with a noisy row, one of few frames and one that shows nothing; a note.
std::string made_report(const std::string& scene = "urban");

/// The same with a Pareto front on `natural` in place of the tables, settings left out.
std::string made_pareto_report();

/// Pictures of the first three rows of made_report(): a gradient, a darker one that all three
/// share, and a heat map with a hatch and an error without a bound.
std::vector<bench::RowPictures> made_pictures(int cols = 64, int rows = 48);

} // namespace reljef::test
