#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/core/atomic_file.h"
#include "engine/core/result.h"

namespace reljef::io {

/// A keyframe of a camera path; scene metres, seconds.
struct PathKey {
    double time = 0.0;
    glm::dvec3 eye{0.0};
    glm::dvec3 target{0.0};
};

/// A keyframe on Earth; degrees, metres, seconds.
struct GeodeticKey {
    double time = 0.0;
    double latitude = 0.0;
    double longitude = 0.0;
    std::optional<double> height;  ///< above the DEM's own zero; absent: chosen by the flight
    std::optional<double> heading; ///< clockwise from north; absent: along the path
    std::optional<double> pitch;   ///< above the horizon, [-90, 90]; only with a heading
};

/// A flight through a scene or over the Earth.
struct Flight {
    std::variant<std::vector<PathKey>, std::vector<GeodeticKey>> keys;
    std::vector<std::string> notes; ///< unused parts of the file
};

/// Reads a flight of 1 to 100,000 keys with increasing times:
/// - TOML: `[[key]]` tables with time, eye = [x,y,z] and look = [x,y,z], or with time, latitude,
///   longitude, height and optionally heading and pitch;
/// - any other file: see read_track.
Result<Flight> read_flight(const std::filesystem::path& path, double metres_a_second = 100.0);

/// A file that read_flight() reads, ready for commit(): TOML for .toml, a GPX track for .gpx. A
/// track has times since 1970 and no angles. Fails for other extensions, and for a track of keys
/// that are not on Earth.
Result<AtomicFile> prepare_flight(const std::filesystem::path& path, const Flight& flight);
/// Writes that file whole or not at all.
Result<void> write_flight(const std::filesystem::path& path, const Flight& flight);

/// Reads all segments of the first track, route or line of a file that GDAL opens (GPX, KML,
/// GeoJSON, …), in any CRS.
Result<Flight> read_track(const std::filesystem::path& path, double metres_a_second);

} // namespace reljef::io
