#pragma once

#include <filesystem>

#include <OpenImageIO/imageio.h>

#include "engine/core/result.h"

namespace reljef::io {

/// Whether the path names a file that is not empty and, if a PNG, not cut short: libpng prints its
/// errors, which a library must not.
Result<void> check_image_file(const std::filesystem::path& path);

/// Whether the size a picture's header claims can be true of a file that long, and fits memory.
Result<void> check_image_size(const std::filesystem::path& path, const OIIO::ImageSpec& spec);

} // namespace reljef::io
