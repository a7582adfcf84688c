#pragma once

#include <string>
#include <vector>

#include <gdal_priv.h>

#include "engine/core/color.h"
#include "engine/core/result.h"
#include "engine/io/raster.h"
#include "engine/io/sample_grid.h"

namespace reljef::io {

/// RasterOptions::imagery over the samples `grid` of the raster `heights`, edge sample to edge
/// sample; see read_terrain.
Result<Image> read_imagery(GDALDataset& heights, const SampleGrid& grid,
                           const RasterOptions& options, std::vector<std::string>& notes);

} // namespace reljef::io
