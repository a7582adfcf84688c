#pragma once

#include <string>
#include <vector>

#include <gdal_priv.h>

#include "engine/core/color.h"
#include "engine/core/result.h"
#include "engine/io/raster/georeferencing.h"
#include "engine/io/raster/raster.h"

namespace reljef::io {

/// RasterOptions::imagery over the samples at `place` of the raster `heights`, with those that
/// close it, edge sample to edge sample; see read_terrain. Images that cannot be read are told in
/// `faults`; fails where that is so of all.
Result<Image> read_imagery(GDALDataset& heights, const Place& place, const RasterOptions& options,
                           std::vector<std::string>& notes, std::vector<std::string>& errors);

} // namespace reljef::io
