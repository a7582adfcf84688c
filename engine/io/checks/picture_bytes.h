#pragma once

#include <string>

#include "engine/core/result.h"

namespace reljef::io {

// Limits that the libraries that decode pictures do not have. A name is as GDAL takes it.

/// How far a PNG is looked through. GDAL reads nothing behind the first pixels.
enum class PngPart { until_pixels, whole };

/// To call before a PNG is opened. Fails if libpng would hold over 64 MB of texts and colour
/// profiles of it, and, if it is looked through as a whole, if its end is missing. Other files are
/// no errors. Reads the heads of chunks alone.
Result<void> check_png(const std::string& name, PngPart part);

/// Fails if a TGA file of `cols`×`rows` pixels is too short for them. GDAL takes missing ones for
/// black.
Result<void> check_tga(const std::string& name, int cols, int rows);

} // namespace reljef::io
