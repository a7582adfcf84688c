#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <glm/vec2.hpp>
#include <ogr_spatialref.h>

namespace reljef::io {

/// West, south, east, north, degrees.
using DegreeBox = std::array<double, 4>;

/// WGS 84, longitude and latitude in degrees, as GDAL reads it.
inline const std::string wgs84_degrees = "EPSG:4326";

/// From text (WKT, "EPSG:…"), with x east and y north.
OGRSpatialReference crs_from_text(const std::string& text);

/// PROJ's way from one coordinate system to another. One thread at a time.
class CrsTransform {
public:
    /// The best operation for the area where one is given; absent where there is none.
    static std::optional<CrsTransform> create(const std::string& from, const std::string& to,
                                              const std::optional<DegreeBox>& area = {});

    /// (x, y), or (longitude, latitude), in place; NaN where a point has no place.
    void apply(std::span<glm::dvec2> points) const;

private:
    struct Deleter {
        void operator()(OGRCoordinateTransformation* transform) const {
            OGRCoordinateTransformation::DestroyCT(transform);
        }
    };
    using Transformation = std::unique_ptr<OGRCoordinateTransformation, Deleter>;
    explicit CrsTransform(Transformation transform) : transform_(std::move(transform)) {}

    Transformation transform_;
};

} // namespace reljef::io
