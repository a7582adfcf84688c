#pragma once

#include <filesystem>
#include <string>

#include "bench/baselines/peers.h"
#include "engine/core/result.h"

namespace reljef::bench {

/// As JSON of the schema "reljef-bench-peers/1": times milliseconds, errors pixels, null where no
/// pixel shows terrain.
std::string peers_json(const PeersResults& results);

/// A table for people; each pose's frame rates are told in terms of its polygons:error=1.
std::string peers_table(const PeersResults& results);

/// Writes the file (an empty path: none) and prints the table. A run that failed leaves an earlier
/// file as it is. Fails with PeersResults::stopped too.
Result<void> report(const PeersResults& results, const std::filesystem::path& json);

} // namespace reljef::bench
