#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/grid.h"
#include "engine/core/result.h"
#include "engine/geo/geoid.h"

namespace reljef::geo {

/// Position on WGS 84: degrees north, degrees east, metres above the ellipsoid. Without a geoid the
/// height counts from the DEM's own zero.
struct Geodetic {
    double latitude = 0.0;
    double longitude = 0.0;
    double height = 0.0;
};

/// A rectangle in degrees; east may exceed 180 and is at most west + 360.
struct GeodeticArea {
    double south = -90.0;
    double west = -180.0;
    double north = 90.0;
    double east = 180.0;
};

/// Pixel to CRS coordinates: x = x0 + col·x_col + row·x_row, y likewise. (0,0) is the CENTRE of the
/// north-west sample.
struct PixelAffine {
    double x0 = 0.0;
    double x_col = 1.0;
    double x_row = 0.0;
    double y0 = 0.0;
    double y_col = 0.0;
    double y_row = -1.0;

    [[nodiscard]] glm::dvec2 crs_from_pixel(glm::dvec2 pixel) const {
        return {x0 + pixel.x * x_col + pixel.y * x_row, y0 + pixel.x * y_col + pixel.y * y_row};
    }
    friend bool operator==(const PixelAffine&, const PixelAffine&) = default;
};

/// Extra samples that close a global raster at the antimeridian and the poles.
struct GlobalWrap {
    bool around = false; ///< the last column equals the first
    bool east = false;   ///< adds that last column
    /// Distance of an added pole row from the outermost row, in rows, (0, 1]; 0: none.
    double north = 0.0;
    double south = 0.0;
    bool begins_at_pole = false; ///< the first row lies on a pole, added or not
    bool ends_at_pole = false;   ///< so does the last one

    [[nodiscard]] int cols() const { return east ? 1 : 0; }
    [[nodiscard]] int north_rows() const { return north > 0.0 ? 1 : 0; }
    [[nodiscard]] int south_rows() const { return south > 0.0 ? 1 : 0; }
    [[nodiscard]] int rows() const { return north_rows() + south_rows(); }
};

/// Row coordinates of a closed raster: pole rows are closer to their neighbours than other rows.
class WrappedRows {
public:
    WrappedRows() = default;
    WrappedRows(const GlobalWrap& wrap, int source_rows)
        : closing_(wrap), last_(source_rows - 1.0) {}

    [[nodiscard]] const GlobalWrap& wrap() const { return closing_; }
    /// The last row of the source, as a row of the closed raster.
    [[nodiscard]] double last_source_row() const { return last_ + closing_.north_rows(); }
    /// Converts between rows of the closed raster and rows of the source.
    [[nodiscard]] double source_row(double row) const;
    [[nodiscard]] double closed_row(double source_row) const;
    /// Rows of the closed raster at their distances on the Earth: those of the source, from an
    /// added pole row on.
    [[nodiscard]] double even_row(double row) const {
        return source_row(row) + closing_.north_rows();
    }
    [[nodiscard]] double from_even_row(double even_row) const {
        return closed_row(even_row - closing_.north_rows());
    }

private:
    GlobalWrap closing_;
    double last_ = 0.0;
};

/// Samples that are even in latitude and longitude, with even rows (WrappedRows::even_row).
struct DegreeGrid {
    glm::dvec2 first{0.0};            ///< latitude and longitude of (0, 0)
    glm::dmat2 samples_a_degree{1.0}; ///< (col, row) per degree of latitude, and of longitude
    double middle_longitude = 0.0;    ///< columns follow longitudes up to 180 degrees beside it
    WrappedRows rows;
};

/// WGS 84 latitude and longitude of any (col, row) of a raster in any CRS. Interpolates exact
/// values at control points bicubically (four-point Lagrange). engine/io checks the error.
class GeodeticMap {
public:
    /// Empty map; assign before use.
    GeodeticMap() = default;

    /// `control(i, j)` is (latitude, longitude) in degrees at (col, row) = first + step·(i, j).
    /// Longitudes are continuous across the antimeridian. Preconditions: at least 4×4 control
    /// points, step > 0.
    GeodeticMap(const Grid<glm::dvec2>& control, glm::dvec2 first, glm::dvec2 step);

    /// From unit normals of the ellipsoid (normal_from_geodetic), for rasters around a pole.
    GeodeticMap(const Grid<glm::dvec3>& normals, glm::dvec2 first, glm::dvec2 step);

    /// The map of the closed raster; the source has `cols`×`rows` samples.
    [[nodiscard]] GeodeticMap closed(const GlobalWrap& wrap, int cols, int rows) const;
    [[nodiscard]] const WrappedRows& rows() const { return rows_; }
    /// Empty unless the raster is even in degrees.
    [[nodiscard]] std::optional<DegreeGrid> degree_grid() const;
    /// The map of samples `factor` of these apart, from the same first one. Precondition: factor >
    /// 0; the raster is not closed.
    [[nodiscard]] GeodeticMap resampled(glm::dvec2 factor) const;

    /// (latitude, longitude), degrees. Extrapolates outside the control points, but not past a
    /// pole.
    [[nodiscard]] glm::dvec2 latitude_longitude(glm::dvec2 sample) const;

    /// Whether a sample lies past a pole by more than 0.1 mm.
    [[nodiscard]] bool is_past_pole(glm::dvec2 sample) const;

    /// The (col, row) of a latitude and longitude (modulo 360), by Newton's method. May lie outside
    /// the raster. Fails if it does not converge to 1e-9 samples.
    [[nodiscard]] Result<glm::dvec2> sample(double latitude, double longitude) const;

private:
    enum class Kind { degrees, normals };
    struct Value {
        glm::dvec3 at{0.0};     // relative to base_
        glm::dvec3 by_col{0.0}; // derivatives
        glm::dvec3 by_row{0.0};
    };
    struct Target {
        glm::dvec3 at{0.0};                     // relative to base_
        std::array<glm::dvec3, 2> directions{}; // of the residual
    };
    GeodeticMap(Grid<glm::dvec3> control, glm::dvec2 first, glm::dvec2 step, Kind kind);
    [[nodiscard]] Value evaluate(glm::dvec2 sample) const;
    [[nodiscard]] Target target(double latitude, double longitude) const;
    void find_linear_inverse();
    [[nodiscard]] glm::dvec2 middle() const;

    Kind kind_ = Kind::degrees;
    Grid<glm::dvec3> control_; // (latitude, longitude, 0) or normals, relative to base_
    /// To control points from degrees relative to the first one: of a raster in degrees.
    std::optional<glm::dmat2> linear_inverse_;
    glm::dvec3 base_{0.0};          // separate: keeps precision of differences
    double middle_longitude_ = 0.0; // degrees
    glm::dvec2 first_{0.0};
    glm::dvec2 step_{1.0};
    WrappedRows rows_;
};

/// Position of a raster on the Earth.
struct Georeference {
    std::string crs_name;        ///< "WGS 84 / UTM zone 10N"
    std::string crs_code;        ///< "EPSG:26710", or empty
    std::string wkt;             ///< full CRS definition
    PixelAffine crs_from_pixel;  ///< in the CRS's own horizontal units
    std::string horizontal_unit; ///< "metre", "degree", "US survey foot", …
    std::string vertical_datum;  ///< "EGM96 height", "ellipsoidal height", …; empty: unknown
    GeodeticMap geodetic;        ///< WGS 84
    std::optional<Geoid> geoid;  ///< reference of the heights, if applied
};

/// Whether this vertical datum is the ellipsoid.
bool is_ellipsoidal(std::string_view vertical_datum);
/// Whether this vertical datum is the geoid EGM96.
bool is_egm96(std::string_view vertical_datum);

/// A local east-north-up frame tangent to WGS 84. Round trips near the origin err by up to 1e-8 m.
class LocalFrame {
public:
    /// x east, y north, z up, metres.
    explicit LocalFrame(Geodetic origin);

    [[nodiscard]] glm::dvec3 local_from_geodetic(Geodetic position) const;
    [[nodiscard]] Geodetic geodetic_from_local(glm::dvec3 local) const;
    /// Rotates a geocentric direction into the frame.
    [[nodiscard]] glm::dvec3 local_direction(glm::dvec3 geocentric) const;
    /// Metres from the Earth's centre; z towards the north pole, x towards longitude 0.
    [[nodiscard]] glm::dvec3 geocentric_from_local(glm::dvec3 local) const;
    [[nodiscard]] Geodetic origin() const { return origin_; }

private:
    Geodetic origin_;
    glm::dvec3 center_{0.0};           // geocentric origin
    std::array<glm::dvec3, 3> axes_{}; // geocentric east, north, up
};

inline constexpr double mean_radius_of_earth = 6371008.8; ///< metres (IUGG)

/// Of WGS 84: the equatorial and the polar radius, metres.
glm::dvec2 radii_of_earth();

/// The smallest radius of curvature of WGS 84, metres: b²/a, of the meridian at the equator.
double smallest_radius_of_earth();

/// Geocentric unit normal of the ellipsoid at a latitude and longitude in degrees.
glm::dvec3 normal_from_geodetic(double latitude, double longitude);

/// Geocentric unit vector to the north, in degrees; the longitude defines it at a pole.
glm::dvec3 north_from_geodetic(double latitude, double longitude);

/// Metres per degree on WGS 84: (of longitude, of latitude).
glm::dvec2 metres_per_degree(double latitude);

/// Geodesic distance on WGS 84, metres; ignores heights.
double geodesic_distance(Geodetic from, Geodetic to);

} // namespace reljef::geo
