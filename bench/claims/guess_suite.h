#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "bench/report/figure_table.h"
#include "bench/report/results.h"
#include "bench/runner/suite_options.h"

namespace reljef::bench {

struct GuessOptions {
    SuiteOptions suite;
    std::vector<std::string> terrains{"urban", "natural"}; ///< with colours
};

/// The exact picture of guessed heights, compared with the true heights.
struct GuessRow {
    std::string scene;
    std::string heights;      ///< "flat", "guessed" …
    double correlation = 0.0; ///< of guessed and true heights, [-1,1]
    RowError::Geometric reprojection;
    double wrong_percent = 0.0;
};

struct GuessResults {
    GuessOptions options;
    Environment environment;
    std::vector<GuessRow> rows;
    RunEnd end;
};

FigureTable figure_table(const GuessResults& results);

/// Guesses heights from the colours of each terrain, as `reljef maps --from colors` does, and casts
/// exact rays at them from the pose overview:
/// - flat: the mean height everywhere;
/// - guessed: bright is high, scaled to the true lowest and highest height;
/// - fitted: the scale and offset with the least squared error, the best that anyone could choose.
/// Fails if a terrain has no colours.
GuessResults run_guesses(const GuessOptions& options, const std::stop_token& stop);

} // namespace reljef::bench
