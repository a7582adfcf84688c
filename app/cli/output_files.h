#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "app/cli/options.h"
#include "engine/core/result.h"

namespace reljef::cli {

struct NamedFile {
    std::string option; ///< for messages: "-o", "TERRAIN"
    std::filesystem::path path;
};

/// What the options name that is read.
std::vector<NamedFile> input_files(const TerrainChoice& terrain, const ViewChoice& view);

/// Throws CLI::ParseError if an output would replace an input, a file in an input folder or another
/// output, also under another name. Empty paths are ignored.
void check_distinct(std::span<const NamedFile> outputs, std::span<const NamedFile> inputs);

/// Fails if a file cannot be created. Leaves no files behind, and removes those that killed runs
/// left in their folders. Empty paths are ignored.
Result<void> check_writable(std::span<const NamedFile> outputs);

} // namespace reljef::cli
