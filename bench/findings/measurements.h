#pragma once

#include <string>
#include <vector>

namespace reljef::bench {

/// A results file that findings use, and how it is made.
struct ResultsSource {
    std::string name; ///< the file is NAME.json
    std::string what; ///< it measures, one sentence
    std::string command;
    bool quiet = true; ///< nothing else ran beside it, so that its times hold

    [[nodiscard]] std::string file() const { return name + ".json"; }
    /// That the command runs: "objects", "tables-claims".
    [[nodiscard]] std::string suite() const;
};

std::vector<ResultsSource> results_sources();

} // namespace reljef::bench
