#pragma once

#include <optional>
#include <string>

#include <glm/vec2.hpp>

#include "engine/core/result.h"

namespace reljef::io {

// Limits that the libraries that decode pictures do not have. A name is as GDAL takes it.

/// How far a PNG is looked through. GDAL reads nothing behind the first pixels.
enum class PngPart { until_pixels, whole };

/// To call before a PNG is opened. Fails if libpng would allocate over 64 MB for texts and colour
/// profiles, and if the file ends before the pixels, or before its end if it is looked through as a
/// whole. Other files are no errors. Reads the heads and ends of chunks alone.
Result<void> check_png(const std::string& name, PngPart part);

/// Fails if a TGA file of `cols`×`rows` pixels is too short for them. GDAL takes missing ones for
/// black.
Result<void> check_tga(const std::string& name, int cols, int rows);

/// The size in pixels that a GIF or a WebP claims; absent of other files. Their readers allocate
/// all of it as soon as they open a file.
std::optional<glm::ivec2> claimed_size(const std::string& name);

} // namespace reljef::io
