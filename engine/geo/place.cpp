#include "engine/geo/place.h"

#include <cmath>

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/MGRS.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <glm/vec2.hpp>

#include "engine/core/check.h"

namespace reljef::geo {

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

std::string mgrs_text(const Geodetic& position, int digits) {
    check(digits >= 0 && digits <= 11, "mgrs_text takes 0 to 11 digits");
    check(std::abs(position.latitude) <= 90.0, "latitude outside [-90, 90]");
    int zone = 0;
    bool north = true;
    glm::dvec2 grid{0.0}; // easting, northing
    GeographicLib::UTMUPS::Forward(position.latitude, position.longitude, zone, north, grid.x,
                                   grid.y);
    std::string text;
    GeographicLib::MGRS::Forward(zone, north, grid.x, grid.y, position.latitude, digits, text);
    return text;
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
