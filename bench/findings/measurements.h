#pragma once

#include <string>
#include <vector>

namespace reljef::bench {

/// A results file that findings use, and how it is made.
struct ResultsSource {
    std::string name; ///< the file is NAME.json
    std::string what; ///< it measures, one sentence
    std::string command;
    /// Its times hold: nothing else ran beside it, or its noise floors bound what that changed.
    bool quiet = true;

    [[nodiscard]] std::string file() const { return name + ".json"; }
};

std::vector<ResultsSource> results_sources();

} // namespace reljef::bench
