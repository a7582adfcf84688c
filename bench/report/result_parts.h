#pragma once

#include <filesystem>
#include <vector>

#include "bench/report/results.h"
#include "engine/core/result.h"

namespace reljef::bench {

/// The file of a part: its number instead of "%d" in a name.
std::filesystem::path part_file(const std::filesystem::path& name, const Shard& shard);

/// One run from the parts that several processes measured, in any order. Fails if one is missing,
/// there twice or of another run, or if they were measured in different environments.
Result<Results> merged(std::vector<Results> parts);

/// Reads results; if the name has "%d", all parts ("part-%d.json"), as one run. Fails as
/// read_json_report() and merged().
Result<Results> read_result_parts(const std::filesystem::path& name);

} // namespace reljef::bench
