#pragma once

namespace reljef::geo {

/// A rectangle in degrees; east may exceed 180, and is at most 360 beyond west.
struct GeodeticArea {
    double south = -90.0;
    double west = -180.0;
    double north = 90.0;
    double east = 180.0;
};

} // namespace reljef::geo
