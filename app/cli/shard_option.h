#pragma once

#include <functional>
#include <string>

#include "engine/core/parallel_for.h"
#include "engine/core/result.h"

namespace CLI {
class App;
}

namespace reljef::cli {

inline constexpr int max_shards = 1'000'000;

/// The value of an environment variable; null if it is not set.
using Environment = std::function<const char*(const char* name)>;

/// Parses a shard:
/// - "I/N": shard I of N, from 0 to N-1;
/// - "slurm", "openmpi", "kubernetes": from the variables of that launcher, "auto": of any. "/N"
///   may follow; it must where the launcher does not state the number of its processes.
/// Fails if a variable is absent or wrong, and if launchers or "/N" contradict each other.
Result<Shard> parse_shard(const std::string& text, const Environment& environment);

/// Adds --shard. `items`: what is divided, "frames". Wrong values throw CLI::ParseError.
void add_shard_option(CLI::App& command, Shard& shard, const std::string& items);

/// "0/4".
std::string shard_text(const Shard& shard);

} // namespace reljef::cli
