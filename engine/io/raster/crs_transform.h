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

/// West, south, east, north in degrees.
using DegreeBox = std::array<double, 4>;
DegreeBox united(const DegreeBox& a, const DegreeBox& b);

/// WGS 84: longitude and latitude in degrees.
inline const std::string wgs84_degrees = "EPSG:4326";

/// Metres east and north, at no place on Earth.
inline const std::string plane_metres = R"(LOCAL_CS["plane",UNIT["metre",1]])";

/// Parses WKT or "EPSG:…"; axes x east, y north.
OGRSpatialReference crs_from_text(const std::string& text);
std::string wkt_of(const OGRSpatialReference& crs, const char* format = "FORMAT=WKT2_2019");
/// Whether two texts name one system: GDAL writes some systems in two ways.
bool is_same_crs(const std::string& a, const std::string& b);

/// The code of a system that is not geocentric, or of its geographic one, if it is that of a
/// geocentric one: PROJ ends the program when it looks for a transform of such a system.
std::optional<std::string> false_code_of(const OGRSpatialReference& crs);

/// PROJ's transform between two coordinate systems. One thread at a time.
class CrsTransform {
public:
    /// The best operation, for an area if given; absent if there is none, or false_code_of() one.
    static std::optional<CrsTransform> create(const OGRSpatialReference& from,
                                              const OGRSpatialReference& to,
                                              const std::optional<DegreeBox>& area = {});
    static std::optional<CrsTransform> create(const std::string& from, const std::string& to,
                                              const std::optional<DegreeBox>& area = {});

    /// Transforms (x, y) or (longitude, latitude) in place; NaN where undefined.
    void apply(std::span<glm::dvec2> points) const;

private:
    using Transformation = std::unique_ptr<OGRCoordinateTransformation,
                                           decltype(&OGRCoordinateTransformation::DestroyCT)>;
    explicit CrsTransform(Transformation transform) : transform_(std::move(transform)) {}

    Transformation transform_;
};

} // namespace reljef::io
