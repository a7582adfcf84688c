#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "engine/core/parallel_for.h"
#include "engine/material/cone_map.h"
#include "engine/terrain/mesh/bisection.h"

namespace reljef::io {

/// $XDG_CACHE_HOME/reljef, else $HOME/.cache/reljef (XDG Base Directory Specification 0.8); absent
/// if neither is an absolute path.
std::optional<std::filesystem::path> cache_folder();

/// The folder in cache_folder() in which Mesa's drivers keep shaders; made on demand. Absent where
/// other users could write to it, and on a nearly full disk: Mesa maps a file there, and the system
/// ends a program whose mapped file finds no room.
std::optional<std::filesystem::path> driver_cache_folder();

struct CacheOptions {
    std::optional<std::filesystem::path> folder; ///< created on demand; absent: no cache
    double min_seconds = 0.5;                    ///< faster results are not stored
    ParallelOptions parallel;
};

template <class T> struct Cached {
    std::shared_ptr<const T> value;
    std::string note; ///< why a file was rejected or not written; else empty
};

/// Cache files; their names hold a checksum of the arguments.
std::filesystem::path cone_file(const std::filesystem::path& folder,
                                GridView<const float> unit_heights);
std::filesystem::path bisection_file(const std::filesystem::path& folder,
                                     const terrain::Heightfield& heightfield,
                                     const terrain::Placement& placement);

/// Reads and verifies a cache file, or computes and stores the value. Absent if stopped.
/// Precondition: at least 2×2 heights in [0,1].
std::optional<Cached<material::ConeMaps>> cached_cones(GridView<const float> unit_heights,
                                                       const CacheOptions& options);
/// As cached_cones. Preconditions: those of terrain::Bisection.
std::optional<Cached<terrain::Bisection>> cached_bisection(const terrain::Heightfield& heightfield,
                                                           const terrain::Placement& placement,
                                                           const CacheOptions& options);

} // namespace reljef::io
