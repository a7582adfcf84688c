#pragma once

#include <optional>
#include <span>

#include "engine/geo/georeference.h"
#include "engine/io/raster/crs_transform.h"
#include "engine/io/raster/sample_grid.h"

namespace reljef::io {

/// CRS coordinates of a sample. `affine` maps GDAL's pixel coordinates to the CRS.
glm::dvec2 crs_from_sample(const geo::PixelAffine& affine, const SampleGrid& grid,
                           glm::dvec2 sample);

/// PROJ's transform of a raster's samples to WGS 84.
class ExactTransform {
public:
    /// Uses PROJ's best operation for the grid's area; absent if PROJ has none.
    static std::optional<ExactTransform>
    create(const OGRSpatialReference& crs, const geo::PixelAffine& affine, const SampleGrid& grid);

    /// (col, row) to (latitude, longitude) in degrees, in place. False if a sample has no position.
    [[nodiscard]] bool positions(const SampleGrid& grid, std::span<glm::dvec2> samples) const;

private:
    ExactTransform(CrsTransform transform, const geo::PixelAffine& affine)
        : transform_(std::move(transform)), affine_(affine) {}

    CrsTransform transform_;
    geo::PixelAffine affine_;
};

/// Accepted error of a fitted map, metres.
inline constexpr double map_tolerance = 1e-4;

struct GeodeticFit {
    geo::GeodeticMap map;
    double error = 0.0; ///< largest error between control points, metres
};

/// Fits a map with 9 to 257 control points per side, until its error is within map_tolerance; else
/// the best one. Absent if the exact transform fails for part of the raster.
std::optional<GeodeticFit> fit_geodetic_map(const ExactTransform& exact, const SampleGrid& grid);

} // namespace reljef::io
