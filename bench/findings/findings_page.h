#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "bench/findings/committed_results.h"
#include "bench/findings/conclusion.h"
#include "bench/findings/measurements.h"
#include "engine/core/result.h"

namespace reljef::bench {

/// "82.9 %", "1.93×", "0.62 px".
std::string number_text(const Figure& figure, const Number& number);

/// The page as GitHub Markdown, for a file in docs. Fails as CommittedResults::number.
Result<std::string> findings_page(const Findings& findings, std::span<const ResultsSource> sources,
                                  const CommittedResults& results);

/// The page of all_findings(). Fails as CommittedResults::number.
Result<std::string> findings_page(const CommittedResults& results);

/// Those of results_sources() in a folder. Fails as CommittedResults::read, and if a file has
/// results of another suite.
Result<CommittedResults> read_all_results(const std::filesystem::path& folder);

} // namespace reljef::bench
