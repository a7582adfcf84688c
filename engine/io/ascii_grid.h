#pragma once

#include <filesystem>

#include "engine/io/gdal_dataset.h"

namespace reljef::io {

/// As open_raster, and fails where an ASCII grid has fewer values than its header says: GDAL finds
/// a row from those before it, and behind one that is missing seeks all of these again for each,
/// twice as long with every row. Reads all of such a file.
Result<Dataset> open_whole_raster(const std::filesystem::path& path, const GdalMessages& messages);

} // namespace reljef::io
