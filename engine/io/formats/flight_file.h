#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/core/result.h"
#include "engine/io/formats/scene_file.h"

namespace reljef::io {

/// One key of a fly path on Earth; degrees, metres, seconds.
struct GeodeticKey {
    double time = 0.0;
    double latitude = 0.0;
    double longitude = 0.0;
    std::optional<double> height;  ///< above the DEM's own zero; absent: as the flyer sees fit
    std::optional<double> heading; ///< clockwise from north; absent: along the way
    std::optional<double> pitch;   ///< above the horizon, [-90, 90]; given with a heading only
};

/// A flight through a scene, or one over the Earth.
struct Flight {
    std::variant<std::vector<PathKey>, std::vector<GeodeticKey>> keys;
    std::vector<std::string> notes; ///< what of the file is not flown: a sentence each
};

/// A flight: a path file (TOML, see read_path_file; or `[[key]]` tables with time, latitude,
/// longitude, height and perhaps heading and pitch), or the first track, route or line of a GPX,
/// KML, GeoJSON or any other file of lines that GDAL opens, in any coordinate system, flown at
/// `metres_a_second`, the segments of a track one after the other. At least one key, at most
/// 100,000. Errors as everywhere.
Result<Flight> read_flight(const std::filesystem::path& path, double metres_a_second = 100.0);

/// The first track, route or line of a file that GDAL opens, with all its segments, as keys on
/// Earth: see read_flight.
Result<Flight> read_track(const std::filesystem::path& path, double metres_a_second);

} // namespace reljef::io
