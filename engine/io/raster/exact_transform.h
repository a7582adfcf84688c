#pragma once

#include <memory>
#include <optional>
#include <span>

#include <glm/vec2.hpp>
#include <ogr_spatialref.h>

#include "engine/geo/georeference.h"
#include "engine/io/raster/sample_grid.h"

namespace reljef::io {

/// CRS coordinates of a sample.
glm::dvec2 crs_from_sample(const geo::PixelAffine& affine, const SampleGrid& grid,
                           glm::dvec2 sample);

/// PROJ's transform of a raster's samples to WGS 84.
class ExactTransform {
public:
    /// `affine` takes GDAL's pixel coordinates to the CRS. One operation for the whole grid: the
    /// best of those PROJ knows for where the grid lies. Absent where there is none.
    static std::optional<ExactTransform>
    create(const OGRSpatialReference& crs, const geo::PixelAffine& affine, const SampleGrid& grid);

    /// (col, row) of `grid` to (latitude, longitude) in degrees, in place; false where one has
    /// none.
    [[nodiscard]] bool positions(const SampleGrid& grid, std::span<glm::dvec2> samples) const;

private:
    struct Deleter {
        void operator()(OGRCoordinateTransformation* transform) const {
            OGRCoordinateTransformation::DestroyCT(transform);
        }
    };
    using Transformation = std::unique_ptr<OGRCoordinateTransformation, Deleter>;

    ExactTransform(Transformation transform, const geo::PixelAffine& affine)
        : transform_(std::move(transform)), affine_(affine) {}

    Transformation transform_;
    geo::PixelAffine affine_;
};

} // namespace reljef::io
