#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "engine/core/result.h"

namespace reljef::io {

/// The name by which GDAL opens a file of lines or outlines: of a KMZ that of the KML in it
/// ("doc.kml", else the first one), of others the path. GDAL would not check how much a KMZ holds.
/// Fails, with one sentence, if a KMZ holds no KML, or one of over `max_bytes`, whatever it states,
/// and as archive_members().
Result<std::string> vector_file_name(const std::filesystem::path& path, std::uintmax_t max_bytes);

} // namespace reljef::io
