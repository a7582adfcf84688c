#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/grid.h"
#include "engine/core/result.h"
#include "engine/geo/geoid.h"

namespace reljef::geo {

/// Geodetic position on WGS 84: degrees north, degrees east, metres (above the ellipsoid, or above
/// the DEM's own zero where no geoid is applied).
struct Geodetic {
    double latitude = 0.0;
    double longitude = 0.0;
    double height = 0.0;
};

/// Pixel to CRS coordinates: x = x0 + col·x_col + row·x_row, y likewise, with (col, row) = (0,0) at
/// the CENTRE of the north-west sample (pixel-is-area sources are shifted by half a cell on
/// reading).
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

/// Samples beside those of a source that goes all around the Earth, so that nothing is missing
/// between its last column and its first, and around the poles.
struct GlobalWrap {
    bool around = false; ///< the last column lies where the first does
    bool east = false;   ///< it was added: the first again
    /// A row more at the pole, so many rows from the outermost sample, in (0, 1]; 0: none.
    double north = 0.0;
    double south = 0.0;

    [[nodiscard]] int cols() const { return east ? 1 : 0; }
    [[nodiscard]] int north_rows() const { return north > 0.0 ? 1 : 0; }
    [[nodiscard]] int south_rows() const { return south > 0.0 ? 1 : 0; }
    [[nodiscard]] int rows() const { return north_rows() + south_rows(); }
};

/// The rows of a closed raster: between a pole's and the outermost of the source they are closer
/// together than elsewhere.
class ClosedRows {
public:
    ClosedRows() = default;
    ClosedRows(const GlobalWrap& closing, int source_rows)
        : closing_(closing), last_(source_rows - 1.0) {}

    [[nodiscard]] const GlobalWrap& closing() const { return closing_; }
    /// From a row of the closed raster, 0 the first of all, to that of the source, and back.
    [[nodiscard]] double source_row(double row) const;
    [[nodiscard]] double closed_row(double source_row) const;

private:
    GlobalWrap closing_;
    double last_ = 0.0; // of the source
};

/// WGS 84 latitude and longitude of any (col, row) of a raster, whatever its CRS: values of the
/// exact transform at control points, with bicubic (four-point Lagrange) interpolation between
/// them. Whoever builds it chooses the control points dense enough and checks them (engine/io).
class GeodeticMap {
public:
    /// Maps nothing: to be assigned before use.
    GeodeticMap() = default;

    /// `control(i, j)` is (latitude, longitude) in degrees at col = i·step.x + first.x, row
    /// likewise. Longitudes run on across the antimeridian (no jump of 360). Preconditions: at
    /// least 4×4 control points, step > 0.
    GeodeticMap(const Grid<glm::dvec2>& control, glm::dvec2 first, glm::dvec2 step);

    /// The same from unit normals of the ellipsoid (normal_from_geodetic): for rasters around a
    /// pole, where longitudes cannot run on.
    GeodeticMap(const Grid<glm::dvec3>& normals, glm::dvec2 first, glm::dvec2 step);

    /// The same map with the samples of a closing around `cols`×`rows` of a source: (0,0) is now
    /// the first of all.
    [[nodiscard]] GeodeticMap closed(const GlobalWrap& closing, int cols, int rows) const;
    [[nodiscard]] const ClosedRows& rows() const { return rows_; }

    /// (latitude, longitude), degrees. Outside the control points the outermost cubic runs on, but
    /// not past a pole.
    [[nodiscard]] glm::dvec2 latitude_longitude(glm::dvec2 sample) const;

    /// Whether a sample lies farther than the pole that latitude_longitude gives for it, and not by
    /// rounding (a tenth of a millimetre).
    [[nodiscard]] bool is_past_pole(glm::dvec2 sample) const;

    /// The (col, row) that lies at a latitude and longitude (any multiple of 360 away), by Newton's
    /// method; fails where it does not converge to 1e-9 samples. May lie outside the raster.
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
        std::array<glm::dvec3, 2> directions{}; // in which the residual counts
    };
    GeodeticMap(Grid<glm::dvec3> control, glm::dvec2 first, glm::dvec2 step, Kind kind);
    [[nodiscard]] Value evaluate(glm::dvec2 sample) const;
    [[nodiscard]] Target target(double latitude, double longitude) const;
    [[nodiscard]] glm::dvec2 middle() const;

    Kind kind_ = Kind::degrees;
    Grid<glm::dvec3> control_;      // (latitude, longitude, 0) or normals, relative to base_
    glm::dvec3 base_{0.0};          // kept apart: differences of neighbours keep their digits
    double middle_longitude_ = 0.0; // degrees
    glm::dvec2 first_{0.0};
    glm::dvec2 step_{1.0};
    ClosedRows rows_;
};

/// Where a raster lies on the Earth.
struct Georeference {
    std::string crs_name;        ///< as the CRS calls itself, "WGS 84 / UTM zone 10N"
    std::string crs_code;        ///< "EPSG:26710", or empty where it has none
    std::string wkt;             ///< the whole definition
    PixelAffine crs_from_pixel;  ///< in the CRS's own horizontal units
    std::string horizontal_unit; ///< "metre", "degree", "US survey foot", …
    std::string vertical_datum;  ///< "EGM96 height", "ellipsoidal height", …; empty: unknown
    GeodeticMap geodetic;        ///< WGS 84
    std::optional<Geoid> geoid;  ///< from which heights count; absent: they are taken as they are
};

/// Whether heights that count from a vertical datum of this name are heights above the ellipsoid:
/// no geoid lies between.
bool is_ellipsoidal(std::string_view vertical_datum);

/// A local east-north-up frame tangent to WGS 84. There and back again is within 1e-8 m near the
/// origin (what degrees in double can tell).
class LocalFrame {
public:
    /// Origin at `origin`; x east, y north, z up, metres.
    explicit LocalFrame(Geodetic origin);

    [[nodiscard]] glm::dvec3 local_from_geodetic(Geodetic position) const;
    [[nodiscard]] Geodetic geodetic_from_local(glm::dvec3 local) const;
    /// A geocentric direction (normal_from_geodetic) in the frame's own axes.
    [[nodiscard]] glm::dvec3 local_direction(glm::dvec3 geocentric) const;
    [[nodiscard]] Geodetic origin() const { return origin_; }

private:
    Geodetic origin_;
    glm::dvec3 center_{0.0};           // of the origin, geocentric
    std::array<glm::dvec3, 3> axes_{}; // east, north, up, geocentric
};

/// Unit vector away from the Earth at a latitude and longitude (degrees), geocentric: x towards
/// (0,0), y towards (0,90), z towards the north pole.
glm::dvec3 normal_from_geodetic(double latitude, double longitude);

/// Unit vector towards the north pole, level at a latitude and longitude (degrees), geocentric. At
/// a pole the longitude says which way that is.
glm::dvec3 north_from_geodetic(double latitude, double longitude);

/// Metres per degree of latitude and of longitude at a latitude on WGS 84: (per longitude degree,
/// per latitude degree).
glm::dvec2 metres_per_degree(double latitude);

/// Geodesic distance between two positions on WGS 84, metres (heights are not looked at).
double geodesic_distance(Geodetic from, Geodetic to);

} // namespace reljef::geo
