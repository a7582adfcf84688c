#pragma once

#include <filesystem>
#include <optional>

#include "engine/io/raster/gdal_dataset.h"

namespace reljef::io {

/// Whether overviews average heights with voids that the raster does not declare, which leaves pits
/// around each void (GDAL leaves declared voids out). Compares the eight steepest drops of one
/// small overview with the full-resolution samples behind them. Misses a single void if that
/// overview is coarser than 1/16, or if cliffs are steeper. Absent if the samples cannot be read.
std::optional<bool> overviews_mix_voids(GDALDataset& dataset, const std::filesystem::path& path);

/// For notes and faults, after the file's name.
inline constexpr const char* mixed_overviews_note =
    "its overviews are averages of heights and of voids that it does not declare: they are not "
    "used";

/// `opened`, or the same raster without its overviews where they mix voids with heights.
struct CheckedRaster {
    Dataset dataset;
    std::optional<bool> mixed_overviews; ///< absent where they could not be read
};
Result<CheckedRaster> without_mixed_overviews(Dataset opened, const std::filesystem::path& path,
                                              const GdalMessages& messages);

} // namespace reljef::io
