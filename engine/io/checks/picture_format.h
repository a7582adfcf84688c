#pragma once

#include <string>

#include "engine/core/result.h"

namespace reljef::io {

/// OpenImageIO's name of a picture's format, by its first bytes; TGA, which has none, by its
/// extension. Fails for all other formats: OpenImageIO also opens videos, raw photos, volumes and
/// playlists, which may name other files and servers.
Result<std::string> picture_format(const std::string& name);

} // namespace reljef::io
