#pragma once

#include <filesystem>
#include <map>
#include <mutex>

#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/raster/mixed_overviews.h"

namespace reljef::io {

/// Opens rasters as open_whole_raster, but reads of an ASCII grid all values, and looks at a file's
/// overviews, only the first time.
/// Safe from several threads at a time.
class WholeRasters {
public:
    Result<CheckedRaster> open(const std::filesystem::path& path, const GdalMessages& messages);

private:
    std::mutex mutex_;
    struct Known {
        std::filesystem::file_time_type changed;
        bool mixed_overviews = false;
    };
    std::map<std::filesystem::path, Known> whole_;
};

/// As open_raster, without overviews that mix voids with heights, and fails where an ASCII grid has
/// fewer values than its header says: GDAL finds a row from those before it, and behind one that is
/// missing seeks all of these again for each, twice as long with every row. Reads all of such a
/// file.
Result<CheckedRaster> open_whole_raster(const std::filesystem::path& path,
                                        const GdalMessages& messages);

} // namespace reljef::io
