#pragma once

#include <filesystem>
#include <optional>

#include "engine/core/result.h"
#include "engine/geo/geoid.h"

namespace reljef::io {

/// A geoid: a .pgm of GeographicLib, or a raster in degrees that GDAL opens and whose values are
/// metres above the ellipsoid (egm96_15.gtx, …). Errors name the file, what was found and what was
/// expected.
Result<geo::Geoid> read_geoid(const std::filesystem::path& path);

/// The EGM96 geoid that PROJ or GeographicLib have installed on this machine, where there is one.
std::optional<std::filesystem::path> installed_geoid();

} // namespace reljef::io
