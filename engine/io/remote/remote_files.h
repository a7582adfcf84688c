#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "engine/core/result.h"

namespace reljef::io {

// Files on servers for GDAL, as "/vsicurl/" and an address. They replace GDAL's own reader,
// which cannot be stopped and follows redirects to this machine. HttpClient has the deadlines and
// the rules for redirects.

/// Replaces GDAL's reader of "/vsicurl/". Call it once, after GDAL's drivers are registered.
void install_remote_files();

/// Clears what is cached of a file, including a failure. `name`: an address, "/vsicurl/" or not.
void forget_remote_file(const std::string& name);

/// Reads a whole file in one request; absent if the server has none. The error does not name it.
Result<std::optional<std::string>> read_remote_file(const std::string& url, std::size_t max_bytes);

} // namespace reljef::io
