#pragma once

#include <filesystem>
#include <optional>
#include <variant>
#include <vector>

#include "engine/core/result.h"
#include "engine/io/scene_file.h"

namespace reljef::io {

/// One key of a fly path on Earth; degrees, metres, seconds.
struct GeodeticKey {
    double time = 0.0;
    double latitude = 0.0;
    double longitude = 0.0;
    std::optional<double> height;  ///< above the DEM's own zero; absent: as the flyer sees fit
    std::optional<double> heading; ///< clockwise from north; absent: towards the next key
    std::optional<double> pitch;   ///< above the horizon, [-90, 90]; given with a heading only
};

using Flight = std::variant<std::vector<PathKey>, std::vector<GeodeticKey>>;

/// A flight: a path file (TOML, see read_path_file; or `[[key]]` tables with time, latitude,
/// longitude, height and perhaps heading and pitch), or the first line of a GPX, KML, GeoJSON or
/// any other file of lines that GDAL opens, in any coordinate system, flown at `metres_a_second`.
/// At least one key, at most 100,000. Errors as everywhere.
Result<Flight> read_flight(const std::filesystem::path& path, double metres_a_second = 100.0);

/// The line of a file that GDAL opens, as keys of a flight: see read_flight.
Result<std::vector<GeodeticKey>> read_track(const std::filesystem::path& path,
                                            double metres_a_second);

} // namespace reljef::io
