#pragma once

#include <filesystem>

#include "engine/core/result.h"
#include "engine/io/raster/raster.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::io {

/// Any raster GDAL opens, as a terrain: heights in metres, spacing in metres, voids masked and
/// filled, georeference where there is one (checked to 1e-4 m against the exact transform), imagery
/// draped where given. One file, also inside a .zip or .gz; its first band, or the luminance of a
/// picture. South-up rasters are turned. Voids: the declared value, a mask or alpha of 0, NaN,
/// infinity, and −32768 and −32767 even where they are not declared.
///
/// Terrain::color, where imagery is given, has the image's own resolution, at most
/// longest_image_side and a share of the budget; alpha is 0 where the image has nothing, so that a
/// tint shows there.
///
/// Terrain::notes says what is odd about the file. Errors name the file, what was found and
/// what was expected. Nothing is written beside the file. Safe from several threads at a time.
Result<terrain::Terrain> read_terrain(const std::filesystem::path& path,
                                      const RasterOptions& options = {});

} // namespace reljef::io
