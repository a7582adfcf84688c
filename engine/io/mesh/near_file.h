#pragma once

#include <filesystem>
#include <string>

namespace reljef::io {

/// Whether a file that another one names lies in or below `folder`, links followed, and is a
/// regular file.
bool is_file_below(const std::filesystem::path& folder, const std::filesystem::path& file);

/// With its dot, in lower case.
std::string extension_of(const std::filesystem::path& file);

} // namespace reljef::io
