#pragma once

#include <filesystem>
#include <string>

#include "bench/suites/promise.h"
#include "engine/core/result.h"

namespace reljef::bench {

/// As JSON of the schema "reljef-bench-promise/1": times milliseconds, errors pixels, null where
/// there is no figure or no bound.
std::string promise_json(const PromiseResults& results);

/// A table for people.
std::string promise_table(const PromiseResults& results);

/// Writes the file (an empty path: none) and prints the table. A run that failed leaves an earlier
/// file as it is. Fails with PromiseResults::stopped too, and where the promise was not kept.
Result<void> report(const PromiseResults& results, const std::filesystem::path& json);

} // namespace reljef::bench
