#pragma once

#include <filesystem>

namespace reljef::io {

/// Whether a file that another one names lies in or below `folder`, links followed, and is a
/// regular file.
bool is_file_below(const std::filesystem::path& folder, const std::filesystem::path& file);

} // namespace reljef::io
