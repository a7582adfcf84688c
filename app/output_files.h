#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "engine/core/result.h"

namespace reljef::app {

/// A file named on the command line.
struct NamedFile {
    std::string option; ///< as the user knows it: "-o", "TERRAIN"
    std::filesystem::path path;
};

/// Fails where an output would replace an input, a file in a folder that is one, or another output.
/// Paths that are empty are none; two names of one file are one file.
Result<void> check_apart(std::span<const NamedFile> outputs, std::span<const NamedFile> inputs);

} // namespace reljef::app
