#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "engine/core/result.h"

namespace reljef::cli {

/// A file named on the command line.
struct NamedFile {
    std::string option; ///< as the user knows it: "-o", "TERRAIN"
    std::filesystem::path path;
};

/// Refuses outputs (CLI::ParseError) that would replace an input, a file in a folder that is one,
/// or another output. Paths that are empty are none; two names of one file are one file.
void expect_apart(std::span<const NamedFile> outputs, std::span<const NamedFile> inputs);

/// Whether files can be put there. Asked before long work; leaves nothing behind. Paths that are
/// empty are none.
Result<void> check_writable(std::span<const NamedFile> outputs);

} // namespace reljef::cli
