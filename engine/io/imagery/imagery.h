#pragma once

#include <string>
#include <vector>

#include <gdal_priv.h>

#include "engine/core/color.h"
#include "engine/core/result.h"
#include "engine/io/raster/georeferencing.h"
#include "engine/io/raster/raster.h"

namespace reljef::io {

/// Drapes RasterOptions::imagery over the closed samples at `place` of the raster `heights`, edge
/// sample to edge sample. Adds an error for each unreadable image; fails if all are unreadable.
/// Empty if all need overviews: more than 2^31 of their pixels would be read.
Result<Image> read_imagery(GDALDataset& heights, const Place& place, const RasterOptions& options,
                           std::vector<std::string>& notes, std::vector<std::string>& errors);

} // namespace reljef::io
