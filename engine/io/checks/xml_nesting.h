#pragma once

#include <filesystem>

#include "engine/core/result.h"

namespace reljef::io {

/// Elements of XML files of lines and outlines may be nested so deep. GDAL's readers keep over a
/// hundred bytes for each character of deeper ones.
inline constexpr int max_xml_depth = 64;

/// Fails, with one sentence, if elements of a file are nested deeper. A file whose first character
/// opens no element passes: it is no XML. Reads in small pieces, up to the first such place.
Result<void> check_xml_nesting(const std::filesystem::path& path, int max_depth = max_xml_depth);

} // namespace reljef::io
