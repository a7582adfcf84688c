#pragma once

#include <string>

#include <glm/vec3.hpp>

#include "engine/geo/georeference.h"

namespace reljef::geo {

// Coordinate conversions and geodesics on WGS 84. Preconditions: latitudes in [-90, 90] degrees.
// Longitudes may have any multiple of 360.

/// Geocentric metres: x towards (0,0), y towards (0,90), z towards the north pole.
glm::dvec3 geocentric_from_geodetic(const Geodetic& position);
Geodetic geodetic_from_geocentric(glm::dvec3 geocentric);

/// MGRS square. `digits` per coordinate: 0 (100 km) to 11 (1 µm); 5 are metres.
std::string mgrs_text(const Geodetic& position, int digits = 5);

/// The shortest path between two positions; ignores heights.
struct Geodesic {
    double distance = 0.0;      ///< metres
    double azimuth_start = 0.0; ///< degrees clockwise from north, [-180, 180]
    double azimuth_end = 0.0;   ///< direction at the end
};
Geodesic geodesic_between(const Geodetic& from, const Geodetic& to);
/// End of a geodesic from an azimuth in degrees and a distance in metres; keeps the height.
Geodetic geodesic_end(const Geodetic& from, double azimuth, double distance);

} // namespace reljef::geo
