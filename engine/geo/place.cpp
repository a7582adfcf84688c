#include "engine/geo/place.h"

#include <cmath>

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/MGRS.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <fmt/format.h>

#include "engine/core/check.h"

namespace reljef::geo {
namespace {

constexpr int max_mgrs_digits = 11;

void check_latitude(const Geodetic& position) {
    check(std::abs(position.latitude) <= 90.0, "latitude outside [-90, 90]");
}

// GeographicLib throws where a zone does not reach.
UtmUps forward(const Geodetic& position, int zone) {
    UtmUps result;
    GeographicLib::UTMUPS::Forward(position.latitude, position.longitude, result.zone, result.north,
                                   result.easting, result.northing, result.convergence,
                                   result.scale, zone);
    return result;
}

} // namespace

glm::dvec3 geocentric_from_geodetic(const Geodetic& position) {
    glm::dvec3 result{0.0};
    GeographicLib::Geocentric::WGS84().Forward(position.latitude, position.longitude,
                                               position.height, result.x, result.y, result.z);
    return result;
}

Geodetic geodetic_from_geocentric(glm::dvec3 geocentric) {
    Geodetic result;
    GeographicLib::Geocentric::WGS84().Reverse(geocentric.x, geocentric.y, geocentric.z,
                                               result.latitude, result.longitude, result.height);
    return result;
}

UtmUps utm_ups_from_geodetic(const Geodetic& position) {
    check_latitude(position);
    return forward(position, GeographicLib::UTMUPS::STANDARD);
}

Result<UtmUps> utm_ups_in_zone(const Geodetic& position, int zone) {
    check_latitude(position);
    try {
        return forward(position, zone);
    } catch (const GeographicLib::GeographicErr& error) {
        return Error{fmt::format("{},{}: cannot be written in zone {} ({}), a position near the "
                                 "zone was expected",
                                 position.latitude, position.longitude, zone, error.what())};
    }
}

Result<Geodetic> geodetic_from_utm_ups(const UtmUps& position) {
    Geodetic result;
    try {
        GeographicLib::UTMUPS::Reverse(position.zone, position.north, position.easting,
                                       position.northing, result.latitude, result.longitude);
    } catch (const GeographicLib::GeographicErr& error) {
        return Error{fmt::format("zone {}, easting {}, northing {}: is no position ({}), "
                                 "coordinates within a zone were expected",
                                 position.zone, position.easting, position.northing, error.what())};
    }
    return result;
}

std::string utm_ups_text(const UtmUps& position) {
    return fmt::format("{} {:.0f} {:.0f}",
                       GeographicLib::UTMUPS::EncodeZone(position.zone, position.north),
                       position.easting, position.northing);
}

std::string mgrs_text(const Geodetic& position, int digits) {
    check(digits >= 0 && digits <= max_mgrs_digits, "mgrs_text takes 0 to 11 digits");
    const UtmUps grid = utm_ups_from_geodetic(position);
    std::string text;
    GeographicLib::MGRS::Forward(grid.zone, grid.north, grid.easting, grid.northing,
                                 position.latitude, digits, text);
    return text;
}

Result<Geodetic> geodetic_from_mgrs(std::string_view text) {
    UtmUps grid;
    int ignored = 0;
    try {
        GeographicLib::MGRS::Reverse(std::string(text), grid.zone, grid.north, grid.easting,
                                     grid.northing, ignored);
    } catch (const GeographicLib::GeographicErr& error) {
        return Error{fmt::format("'{}' found ({}), an MGRS square like 32TLR3478677541 was "
                                 "expected",
                                 text, error.what())};
    }
    return geodetic_from_utm_ups(grid);
}

Geodesic geodesic_between(const Geodetic& from, const Geodetic& to) {
    Geodesic result;
    GeographicLib::Geodesic::WGS84().Inverse(from.latitude, from.longitude, to.latitude,
                                             to.longitude, result.distance, result.azimuth_start,
                                             result.azimuth_end);
    return result;
}

Geodetic geodesic_end(const Geodetic& from, double azimuth, double distance) {
    Geodetic result{0.0, 0.0, from.height};
    GeographicLib::Geodesic::WGS84().Direct(from.latitude, from.longitude, azimuth, distance,
                                            result.latitude, result.longitude);
    return result;
}

} // namespace reljef::geo
