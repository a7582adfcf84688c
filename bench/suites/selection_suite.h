#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "bench/runner/suite_options.h"
#include "engine/core/result.h"
#include "engine/core/statistics.h"

namespace reljef::bench {

struct SelectionOptions {
    SuiteOptions suite;
    int copies = 60; ///< of a terrain of 13 x 13 tiles, side by side
    int rounds = 1000;
};

/// What choosing the tiles of a view takes, without drawing them.
struct SelectionRow {
    std::string view;
    std::size_t tiles = 0; ///< there are
    std::size_t seen = 0;
    Summary ms;
};

struct SelectionResults {
    std::vector<SelectionRow> rows;
    std::optional<Error> stopped; ///< why the run ended early
};

SelectionResults run_selection(const SelectionOptions& options, const std::stop_token& stop);

std::string selection_table(const SelectionResults& results);
std::string selection_json(const SelectionResults& results);

/// Prints the table and writes the JSON, where one is wanted; fails as what stopped the run.
Result<void> report(const SelectionResults& results, const std::filesystem::path& json);

} // namespace reljef::bench
