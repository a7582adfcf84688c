#pragma once

#include <filesystem>
#include <optional>

#include "engine/core/result.h"
#include "engine/geo/geoid.h"

namespace reljef::io {

/// Reads a .pgm of GeographicLib, or a raster in degrees with metres above the ellipsoid.
Result<geo::Geoid> read_geoid(const std::filesystem::path& path);

/// The EGM96 geoid of the installed PROJ or GeographicLib.
std::optional<std::filesystem::path> installed_geoid();

} // namespace reljef::io
