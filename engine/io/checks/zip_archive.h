#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/result.h"

namespace reljef::io {

struct ArchiveMember {
    std::string path; ///< in the archive
    std::string name; ///< by which GDAL opens it
};

/// The files in a ZIP archive, in the order of its list. Fails, with one sentence, if it is none,
/// or has over 10,000 members, or names of over 255 bytes or 16 folders: GDAL keeps one for each
/// folder of each.
Result<std::vector<ArchiveMember>> archive_members(const std::filesystem::path& path);

/// Fails alike if a name for GDAL is in such an archive: "/vsizip/a.zip/b.tif".
Result<void> check_archives_of(const std::string& name);

} // namespace reljef::io
