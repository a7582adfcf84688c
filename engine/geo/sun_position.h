#pragma once

#include <string_view>

#include "engine/core/result.h"

namespace reljef::geo {

/// A moment in Universal Time, in the Gregorian calendar.
struct UniversalTime {
    int year = 2000;
    int month = 1;      ///< 1 to 12
    int day = 1;        ///< of the month, from 1
    double hours = 0.0; ///< since midnight, [0, 24)
};

inline constexpr int first_sun_year = 1800; ///< of the formula
inline constexpr int last_sun_year = 2200;

/// Degrees.
struct SunPosition {
    double azimuth = 0.0;  ///< clockwise from north, [0, 360)
    double altitude = 0.0; ///< above the horizon, [-90, 90]
};

/// The sun's middle as seen from a place, without refraction, within about 0.02 degrees (Meeus
/// 1998, "Astronomical Algorithms", chapters 12, 13 and 25, low accuracy; dynamical time counts as
/// Universal Time). Fails for a year that is not from first_sun_year to last_sun_year, and for a
/// day or time that does not exist. `latitude`, `longitude`: degrees.
Result<SunPosition> sun_position(const UniversalTime& time, double latitude, double longitude);

/// The same by day: fails, too, while the sun's middle is not above the horizon.
Result<SunPosition> sun_by_day(const UniversalTime& time, double latitude, double longitude);

/// Reads ISO 8601 in Universal Time, "2026-06-21T12:00", with or without seconds and a final Z.
/// Fails for other text, and for a day or time that does not exist. The message names `text`.
Result<UniversalTime> universal_time(std::string_view text);

/// A day of a year, [1, 366], as month and day of the month. Precondition: it exists.
UniversalTime day_of_year(int year, int day);

} // namespace reljef::geo
