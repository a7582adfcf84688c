#pragma once

#include <filesystem>

#include "engine/core/result.h"
#include "engine/io/raster/gdal_dataset.h"

namespace reljef::io {

/// Web tiles as a raster of the Earth: red, green and blue in web mercator, with each coarser level
/// as an overview; black without a tile. Reads each tile when it is needed. A tile that is no
/// picture of 256×256 pixels is an error of reading. Fails as web_tile_source().
Result<Dataset> open_web_tiles(const std::filesystem::path& path);

/// Registers the driver that these rasters name as theirs.
void register_web_tiles();

} // namespace reljef::io
