#pragma once

#include <string>
#include <vector>

#include <gdal_priv.h>

#include "engine/core/color.h"
#include "engine/core/result.h"
#include "engine/io/imagery/imagery_set.h"
#include "engine/io/raster/georeferencing.h"
#include "engine/io/raster/raster.h"

namespace reljef::io {

/// The ground of images over a raster of heights.
ImageryGround imagery_ground(GDALDataset& heights);

/// Drapes RasterOptions::imagery over the closed samples at `place` in the ground's pixels, edge
/// sample to edge sample. Adds an error for each unreadable image; fails if all are unreadable.
/// Empty if all need overviews: more than 2^31 of their pixels would be read.
Result<Image> read_imagery(const ImageryGround& ground, const Place& place,
                           const RasterOptions& options, std::vector<std::string>& notes,
                           std::vector<std::string>& errors);

} // namespace reljef::io
