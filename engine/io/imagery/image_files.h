#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

namespace reljef::io {

struct ImageFiles {
    std::vector<std::filesystem::path> paths; ///< files and addresses, newest first
    double white = 0.0;                       ///< highest white_of()
};

/// Resolves files, addresses and folders (their pictures and Byte or UInt16 rasters) to images.
/// Adds an error for each unreadable file and each file of heights. `white`: if known.
ImageFiles image_files(std::span<const std::filesystem::path> names,
                       std::vector<std::string>& errors, const std::stop_token& stop = {},
                       std::optional<double> white = {});

} // namespace reljef::io
