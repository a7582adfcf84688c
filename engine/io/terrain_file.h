#pragma once

#include <filesystem>

#include "engine/core/result.h"
#include "engine/io/raster/raster.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::io {

/// Reads any raster that GDAL opens, also inside a .zip or .gz, as a terrain:
/// - heights in metres, north up: the first band, or the luminance of a picture;
/// - voids masked and filled: the declared value, a mask or alpha of 0, NaN, infinity, and usual
///   voids even if undeclared (SampleDecoder::isolated_voids);
/// - a georeference if there is one, exact to 1e-4 m;
/// - Terrain::color from the imagery, at its own resolution up to max_image_side and a share of
///   the budget; alpha is 0 outside the images.
/// Terrain::notes reports oddities. Writes no files. Thread-safe.
Result<terrain::Terrain> read_terrain(const std::filesystem::path& path,
                                      const RasterOptions& options = {});

} // namespace reljef::io
