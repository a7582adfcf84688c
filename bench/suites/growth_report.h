#pragma once

#include <filesystem>
#include <string>

#include "bench/suites/growth.h"

namespace reljef::bench {

/// As JSON of the schema "reljef-bench-growth/1": times in seconds where they say so, else
/// milliseconds; errors pixels.
std::string growth_json(const GrowthResults& results);
/// A table for people, and the same in Markdown.
std::string growth_table(const GrowthResults& results);
std::string growth_markdown(const GrowthResults& results);

/// Writes the files (empty paths: none) and prints the table. A run that failed leaves earlier
/// files as they are. Fails with GrowthResults::stopped too.
Result<void> report(const GrowthResults& results, const std::filesystem::path& json,
                    const std::filesystem::path& markdown);

} // namespace reljef::bench
