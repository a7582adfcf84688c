#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

namespace reljef::io {

/// Images that are shown together.
struct ImageFiles {
    std::vector<std::filesystem::path> paths; ///< files and addresses, newest first
    double white = 0.0; ///< of all whose colours are wider than 8 bits: see white_of
};

/// The images that `names` stand for: files, addresses, and folders, whose pictures and 8-bit
/// and unsigned 16-bit rasters are meant. What cannot be opened, or holds heights, is told in
/// `faults`, one sentence each, and left out. `white`, where given, is not looked for anew. Once a
/// stop is asked for no more are looked at.
ImageFiles image_files(std::span<const std::filesystem::path> names,
                       std::vector<std::string>& errors, const std::stop_token& stop = {},
                       std::optional<double> white = {});

} // namespace reljef::io
