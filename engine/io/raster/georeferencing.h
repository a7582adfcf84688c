#pragma once

#include <optional>
#include <string>
#include <vector>

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include "engine/core/result.h"
#include "engine/geo/georeference.h"
#include "engine/io/raster/raster.h"
#include "engine/io/raster/sample_grid.h"

namespace reljef::io {

/// GDAL's geotransform, if any; (0,0) is the outer corner of the first pixel. Precondition:
/// check_affine() passed.
std::optional<geo::PixelAffine> affine_of(GDALDataset& dataset);

/// Maps samples by an affine of their raster's pixels.
geo::PixelAffine affine_of_samples(const geo::PixelAffine& affine, const SampleGrid& grid);

/// Sets a raster's geotransform and CRS (null: none). False if GDAL fails.
bool place_raster(GDALDataset& dataset, const geo::PixelAffine& affine,
                  const OGRSpatialReference* crs);

/// Whether an affine is finite and its pixels are no needles.
bool is_usable(const geo::PixelAffine& affine);

/// Fails for a geotransform that is not usable.
Result<void> check_affine(GDALDataset& dataset, const std::string& name);

/// The horizontal part of a raster's CRS, x east and y north; absent without a CRS. Assumes WGS 84
/// for coordinates that look like degrees, with a note.
std::optional<OGRSpatialReference> horizontal_crs(GDALDataset& dataset,
                                                  std::vector<std::string>& notes);

/// Vertical datum ("EGM96 height") by CRS or format; empty if unknown.
std::string vertical_datum_of(GDALDataset& dataset);

struct CrsNames {
    std::string name; ///< never empty
    std::string code; ///< "EPSG:4326", or empty
    std::string horizontal_unit;
};
CrsNames names_of(const OGRSpatialReference& crs);

/// Position of a raster's samples.
struct Place {
    SampleGrid grid; ///< col grows east and row south
    bool flipped_cols = false;
    bool flipped_rows = false;
    glm::dvec2 spacing{1.0};      ///< metres
    bool spacing_assumed = false; ///< unknown
    std::optional<geo::Georeference> georeference;
    geo::GlobalWrap wrap; ///< applied to `georeference`, but not to `grid`
};

/// Fails for an invalid geotransform, an absurd spacing and a conflicting RasterOptions::spacing.
Result<Place> place_of(GDALDataset& dataset, const SampleGrid& grid, const std::string& name,
                       const RasterOptions& options, std::vector<std::string>& notes);

} // namespace reljef::io
