#pragma once

#include <ogr_spatialref.h>

#include "engine/geo/georeference.h"
#include "engine/io/raster/sample_grid.h"

namespace reljef::io {

/// Samples per 360 degrees of longitude if that is a whole number; else 0. `affine` maps samples.
int samples_around(const OGRSpatialReference& crs, const geo::PixelAffine& affine);

/// The samples that close a global raster: a column that repeats the first one, and rows for poles
/// at most one row away. `affine` maps samples; the first one is in the north-west.
geo::GlobalWrap closing_of(const OGRSpatialReference& crs, const geo::PixelAffine& affine, int cols,
                           int rows);

/// The grid with the samples of a wrap; pole rows lie one step outside.
SampleGrid closed(SampleGrid grid, const geo::GlobalWrap& wrap);

} // namespace reljef::io
