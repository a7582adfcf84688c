#pragma once

#include <cstdint>

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include "engine/core/grid.h"
#include "engine/geo/georeference.h"
#include "engine/io/raster/sample_grid.h"

namespace reljef::io {

/// Samples in a whole turn of longitude, where those of a raster in degrees are a whole number; 0
/// where they are not, and in other coordinate systems. `affine`: of the samples.
int samples_around(const OGRSpatialReference& crs, const geo::PixelAffine& affine);

/// The same of a raster's pixels.
int samples_around(GDALDataset& dataset);

/// What is missing of a raster that goes all around the Earth: the column from its last to its
/// first, and around a pole that is at most a row away. `affine`: of its samples, the first in the
/// north-west.
geo::GlobalWrap closing_of(const OGRSpatialReference& crs, const geo::PixelAffine& affine, int cols,
                           int rows);

/// The samples with those of a closing; at a pole they lie on beyond it.
SampleGrid closed(SampleGrid grid, const geo::GlobalWrap& closing);

/// Heights and voids (empty: none) with those of a closing. A pole has one height: the mean of the
/// outermost row without its voids, and a void where that has nothing else.
void close_samples(Grid<float>& heights, Grid<std::uint8_t>& void_mask,
                   const geo::GlobalWrap& closing);

} // namespace reljef::io
