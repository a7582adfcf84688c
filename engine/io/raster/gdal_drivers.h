#pragma once

#include <string>

#include <cpl_string.h>
#include <gdal_priv.h>

#include "engine/core/result.h"
#include "engine/io/raster/gdal_dataset.h"

namespace reljef::io {

/// The most that GDAL may hold at once to read any sample of a file: 256 MB.
inline constexpr std::size_t max_block_bytes = std::size_t{1} << 28;

/// The formats that reljef reads, and a driver in front of them: every file that GDAL opens, as a
/// source of a virtual raster, an overview, a mask or a web tile, too, is checked as by
/// open_checked. Call once.
void register_formats();

/// Names for GDALOpenEx and GDALIdentifyDriverEx, ending with a null pointer. With
/// allow_external(true): all that GDAL has registered.
CPLStringList format_names();

/// Those of the formats that hold all of their data in one file: only these are opened on a
/// server. Others name more files, which could be local, or addresses.
CPLStringList single_file_formats();

/// Whether one of the formats recognizes the file.
bool has_format(const std::string& name);

/// Whether files may refer to files outside their folder (references.h). Only allow_external sets
/// it, never the environment.
bool allows_external();

struct OpenRequest {
    const char* const* formats = nullptr; ///< as format_names()
    const char* const* options = nullptr;
    const char* const* siblings = nullptr;
    unsigned flags = GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR;
};
/// Opens a file unless its references (references.h) or its sizes are refused: over 10,000 bands,
/// or blocks of over max_block_bytes in it, its overviews or its masks.
/// Null if GDAL cannot open it.
Result<Dataset> open_checked(const std::string& name, const OpenRequest& request);

} // namespace reljef::io
