#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tests/support/test_program.h"

namespace reljef::test {

/// An ESRI ASCII grid of 3 by 3 samples.
inline constexpr std::string_view small_dem =
    "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 10\n1 2 3\n4 5 6\n7 8 9\n";

/// Runs the program `reljef-bench`, as run_forked.
ProgramResult reljef_bench(const std::vector<std::string>& arguments);

} // namespace reljef::test
