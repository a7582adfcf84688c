#pragma once

#include <filesystem>
#include <span>

#include "engine/io/tile_index.h"

namespace reljef::io {

/// A raster by its name, also where its content is cut or empty.
bool is_named_raster(const std::filesystem::path& path);

/// By its name no raster, or a part of one.
bool is_named_side_file(const std::filesystem::path& path);

/// Sets `beside` of all files of a folder and the folders in it: of "a.tif" whatever is named "a.…"
/// and is no raster by its name ("a.prj", "a.tfw", "a.tif.aux.xml"), of an .adf, which is a part of
/// a grid, all .adf files of its folder. Letters' case does not count, as to GDAL.
void set_beside(std::span<IndexedFile> files);

} // namespace reljef::io
