#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "engine/core/parallel_for.h"
#include "engine/terrain/mesh/bisection.h"

namespace reljef::io {

struct BisectionCacheOptions {
    std::optional<std::filesystem::path> folder; ///< made when needed; absent: nothing is kept
    double min_seconds = 0.5;                    ///< what is made sooner is not kept
    ParallelOptions parallel;
};

struct CachedBisection {
    std::shared_ptr<const terrain::Bisection> bisection;
    std::string note; ///< why a file was not used or not kept; empty where all went well
};

/// Where the bisection of these heights, placed so, is kept: the name holds a checksum of both.
std::filesystem::path bisection_file(const std::filesystem::path& folder,
                                     const terrain::Heightfield& heightfield,
                                     const terrain::Placement& placement);

/// As terrain::Bisection, whose preconditions hold here: from its file, which is checked (its
/// version, whose it is, its length, a checksum), else made, and kept. A folder that cannot be
/// written changes nothing but the note. Absent when it was stopped: then nothing is kept.
std::optional<CachedBisection> cached_bisection(const terrain::Heightfield& heightfield,
                                                const terrain::Placement& placement,
                                                const BisectionCacheOptions& options);

} // namespace reljef::io
