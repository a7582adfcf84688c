#pragma once

#include <filesystem>
#include <map>
#include <mutex>

#include "engine/io/raster/gdal_dataset.h"

namespace reljef::io {

/// Opens rasters as open_whole_raster, but reads of an ASCII grid all values only the first time.
/// Safe from several threads at a time.
class WholeRasters {
public:
    Result<Dataset> open(const std::filesystem::path& path, const GdalMessages& messages);

private:
    std::mutex mutex_;
    std::map<std::filesystem::path, std::filesystem::file_time_type> whole_;
};

/// As open_raster, and fails where an ASCII grid has fewer values than its header says: GDAL finds
/// a row from those before it, and behind one that is missing seeks all of these again for each,
/// twice as long with every row. Reads all of such a file.
Result<Dataset> open_whole_raster(const std::filesystem::path& path, const GdalMessages& messages);

} // namespace reljef::io
