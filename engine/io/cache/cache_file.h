#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>

#include "engine/core/atomic_file.h"
#include "engine/core/result.h"

namespace reljef::io {

/// The content of a cache file; absent if there is none. Never blocks and follows no link in the
/// folder. Fails, with one sentence, for a file or folder that another user owns or can write to,
/// for what is no regular file, and for over `max_bytes` bytes.
Result<std::optional<std::string>> read_cache_file(const std::filesystem::path& path,
                                                   std::size_t max_bytes);

enum class CacheAccess { read, write };
/// Opens a file to read, or to read and write; then makes it and its folder on demand. Absent if
/// there is none. Fails as read_cache_file.
Result<std::optional<Descriptor>> open_cache_file(const std::filesystem::path& path,
                                                  CacheAccess access);

/// Makes a folder for this user only, on demand. Fails as read_cache_file.
Result<void> make_cache_folder(const std::filesystem::path& folder);

/// Writes a file of some parts that only this user can read. Makes the folder, for this user only,
/// on demand. Fails as read_cache_file, and if the file cannot be written; then nothing of it is
/// left.
Result<void> write_cache_file(const std::filesystem::path& path,
                              std::initializer_list<std::span<const std::byte>> parts);

} // namespace reljef::io
