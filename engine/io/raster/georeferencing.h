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

/// Once check_affine() has passed: GDAL's geotransform as an affine over its pixel coordinates,
/// (0,0) at the outer corner of the first pixel; absent where the raster has none.
std::optional<geo::PixelAffine> affine_of(GDALDataset& dataset);

/// Fails where a raster has a geotransform that places nothing: not finite, or without area.
Result<void> check_affine(GDALDataset& dataset, const std::string& name);

/// The horizontal part of a raster's CRS with x east and y north; absent where it names none.
/// Degrees without a CRS are taken for WGS 84, with a note.
std::optional<OGRSpatialReference> horizontal_crs(GDALDataset& dataset,
                                                  std::vector<std::string>& notes);

/// What a raster's heights are counted from ("EGM96 height"), by its CRS or its format; empty where
/// neither tells.
std::string vertical_datum_of(GDALDataset& dataset);

/// What a CRS is called: its name, its code ("EPSG:4326", empty where it has none) and its unit.
struct CrsWords {
    std::string name;
    std::string code;
    std::string horizontal_unit;
};
CrsWords words_of(const OGRSpatialReference& crs);

/// Where the samples of a raster lie.
struct Place {
    SampleGrid grid; ///< col grows east and row south
    bool flipped_cols = false;
    bool flipped_rows = false;
    glm::dvec2 spacing{1.0};      ///< metres
    bool spacing_assumed = false; ///< neither the file nor the options tell it
    std::optional<geo::Georeference> georeference;
    /// What is to be added to the samples of a raster that goes all around the Earth; the
    /// georeference has it already, the grid has not.
    geo::GlobalWrap closing;
};

/// Fails where the file places its samples nowhere, absurdly close or far, and where
/// RasterOptions::spacing contradicts it; all else that is odd is noted.
Result<Place> place_of(GDALDataset& dataset, const SampleGrid& grid, const std::string& name,
                       const RasterOptions& options, std::vector<std::string>& notes);

} // namespace reljef::io
