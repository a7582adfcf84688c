#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace reljef::app {

/// A file named on the command line.
struct NamedFile {
    std::string option; ///< as the user knows it: "-o", "TERRAIN"
    std::filesystem::path path;
};

/// Refuses outputs (CLI::ParseError) that would replace an input, a file in a folder that is one,
/// or another output. Paths that are empty are none; two names of one file are one file.
void expect_apart(std::span<const NamedFile> outputs, std::span<const NamedFile> inputs);

} // namespace reljef::app
