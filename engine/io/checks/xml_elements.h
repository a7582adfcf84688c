#pragma once

#include <filesystem>
#include <string>

#include "engine/core/result.h"

namespace reljef::io {

/// The largest depth of elements in files of lines and outlines. GDAL's readers keep over a hundred
/// bytes for each character of deeper ones.
inline constexpr int max_xml_depth = 64;

/// Fails, with one sentence, if elements of a file are nested deeper, also by entities, if a tag
/// or a comment has over 1 MB, or if a track of KML (gx:Track) has more places than times: GDAL
/// reads times that are not there. Reads the file in small pieces, up to the first place that is no
/// well-formed XML: readers end there, too. `name`: as GDAL takes it;
/// messages name the `path`.
Result<void> check_xml(const std::string& name, const std::filesystem::path& path,
                       int max_depth = max_xml_depth);

} // namespace reljef::io
