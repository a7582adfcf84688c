#pragma once

#include <filesystem>
#include <memory>
#include <stop_token>
#include <string>

#include "engine/core/result.h"

namespace reljef::cli {

/// A terrain that a command reads.
struct TerrainInput {
    std::string terrain;
    std::shared_ptr<const std::filesystem::path>
        folder; ///< removed with the last copy; may be null
};

/// The terrain "-" becomes a temporary file with the bytes of standard input, because rasters are
/// not read in order; others stay. A terminal is a usage error (CLI::ParseError). Fails if nothing
/// arrives, the disk is full, or `stop` is requested.
Result<TerrainInput> terrain_input(const std::string& terrain, const std::stop_token& stop);

} // namespace reljef::cli
