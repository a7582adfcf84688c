#pragma once

#include "bench/report/figure_table.h"

namespace reljef::test {

/// Times with a noise floor and errors of two programs on two terrains; one row has no error.
bench::FigureTable made_figures();

} // namespace reljef::test
