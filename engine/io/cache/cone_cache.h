#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "engine/core/parallel_for.h"
#include "engine/material/cone_map.h"

namespace reljef::io {

/// $XDG_CACHE_HOME/reljef, else $HOME/.cache/reljef (XDG Base Directory Specification 0.8); absent
/// where neither is an absolute path.
std::optional<std::filesystem::path> cache_folder();

struct ConeCacheOptions {
    std::optional<std::filesystem::path> folder; ///< made when needed; absent: nothing is kept
    double min_seconds = 1.0;                    ///< what is made sooner is not kept
    ParallelOptions parallel;
};

struct CachedCones {
    std::shared_ptr<const material::ConeMaps> cones;
    std::string note; ///< why a file was not used or not kept; empty where all went well
};

/// Where the cones of these heights are kept: the name holds a checksum of the heights.
std::filesystem::path cone_file(const std::filesystem::path& folder,
                                GridView<const float> unit_heights);

/// The cones over heights in [0,1]: read from their file, which is checked (its version, whose it
/// is, its length, a checksum), else made, and kept. A folder that cannot be written changes
/// nothing but the note. Absent when it was stopped. Precondition: at least 2×2 samples, all
/// finite.
std::optional<CachedCones> cached_cones(GridView<const float> unit_heights,
                                        const ConeCacheOptions& options);

} // namespace reljef::io
