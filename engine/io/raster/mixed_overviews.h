#pragma once

#include <filesystem>
#include <optional>

#include "engine/io/raster/gdal_dataset.h"

namespace reljef::io {

/// Whether overviews are averages of heights and of voids that the raster does not declare (of
/// those it declares GDAL averages nothing): cliffs and pits around each void. Told by the eight
/// samples of one small overview where it falls most steeply, beside the samples they stand for. A
/// single void is missed where that overview is coarser than 1/16, or where cliffs are steeper.
/// Nothing where they cannot be read.
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
