#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>

#include "engine/io/index/index_pass.h"
#include "engine/session/log.h"
#include "engine/session/options.h"

namespace reljef::session {

struct IndexedTerrain {
    std::optional<io::IndexReport> report; ///< absent: it needs no index
    std::string reason;                    ///< why it needs none: a sentence
    std::filesystem::path file;            ///< of the index
    double seconds = 0.0;
};

/// Makes or completes the index of a terrain that does not fit the memory. Logs progress. Fails as
/// open_heights, io::index_source and io::make_index, and without a cache folder.
Result<IndexedTerrain> index_terrain(const SourceOptions& options, Log& log,
                                     const std::stop_token& stop);

} // namespace reljef::session
