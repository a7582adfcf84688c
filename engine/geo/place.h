#pragma once

#include <string>
#include <string_view>

#include <glm/vec3.hpp>

#include "engine/core/result.h"
#include "engine/geo/georeference.h"

namespace reljef::geo {

// Positions on WGS 84 in the other ways they are written, and distances, through GeographicLib.
// Everywhere: latitudes in [-90, 90] degrees (a precondition), longitudes with any multiple of 360.

/// Geocentric, metres: x towards (0,0), y towards (0,90), z towards the north pole.
glm::dvec3 geocentric_from_geodetic(const Geodetic& position);
Geodetic geodetic_from_geocentric(glm::dvec3 geocentric);

/// Universal Transverse Mercator, or Universal Polar Stereographic near the poles.
struct UtmUps {
    int zone = 0;      ///< 1 to 60; 0: UPS
    bool north = true; ///< hemisphere
    double easting = 0.0;
    double northing = 0.0;    ///< metres, false northing of the southern hemisphere included
    double convergence = 0.0; ///< of the grid's north, degrees clockwise from true north
    double scale = 1.0;       ///< metres of the grid in one on the ground
};

/// In the standard zone of the position (with Norway's and Svalbard's exceptions).
UtmUps utm_ups_from_geodetic(const Geodetic& position);
/// In a zone of the caller's choice, 1 to 60, or 0 for UPS; fails too far from it.
Result<UtmUps> utm_ups_in_zone(const Geodetic& position, int zone);
/// At height 0; fails for coordinates beyond the zone's limits.
Result<Geodetic> geodetic_from_utm_ups(const UtmUps& position);
/// Zone and hemisphere, easting and northing in whole metres: "32n 334786 5077541".
std::string utm_ups_text(const UtmUps& position);

/// The square of the Military Grid Reference System that holds the position: `digits` for each of
/// easting and northing, 0 (100 km) to 11 (1 µm); 5 are metres.
std::string mgrs_text(const Geodetic& position, int digits = 5);
/// The middle of a square, at height 0.
Result<Geodetic> geodetic_from_mgrs(std::string_view text);

/// The shortest way between two positions, heights not looked at.
struct Geodesic {
    double distance = 0.0;      ///< metres
    double azimuth_start = 0.0; ///< degrees clockwise from north, [-180, 180]
    double azimuth_end = 0.0;   ///< the direction in which it arrives
};
Geodesic geodesic_between(const Geodetic& from, const Geodetic& to);
/// Where one comes to who starts at `from` with an azimuth (degrees) and goes `distance` metres;
/// keeps the height.
Geodetic geodesic_end(const Geodetic& from, double azimuth, double distance);

} // namespace reljef::geo
