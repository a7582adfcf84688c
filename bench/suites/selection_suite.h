#pragma once

#include <cstddef>
#include <stop_token>
#include <string>
#include <vector>

#include "bench/report/figure_table.h"
#include "bench/runner/suite_options.h"

namespace reljef::bench {

struct SelectionOptions {
    SuiteOptions suite;
    int copies = 60; ///< of a terrain with 13 x 13 tiles, side by side
    int rounds = 1000;
};

/// Time to select the tiles of a view.
struct SelectionRow {
    std::string view;
    std::size_t tiles = 0; ///< in the scene
    std::size_t selected = 0;
    Summary ms;
};

struct SelectionResults {
    Environment environment = {}; ///< nothing is drawn
    int rounds = 0;
    std::vector<SelectionRow> rows = {};
    RunEnd end = {};
};

FigureTable figure_table(const SelectionResults& results);

SelectionResults run_selection(const SelectionOptions& options, const std::stop_token& stop);

} // namespace reljef::bench
