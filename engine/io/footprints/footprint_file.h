#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "engine/building/footprint.h"
#include "engine/core/result.h"

namespace reljef::io {

/// A building of a file.
struct FileFootprint {
    /// Corners are longitude and latitude in degrees, or x and y of the file.
    building::Footprint shape;
    std::optional<double>
        height; ///< metres, in (0, max_building_height]; absent: the options name none
};

inline constexpr double max_building_height = 1000.0;           ///< metres
inline constexpr std::size_t max_footprint_corners = 2'000'000; ///< of all that a file holds
inline constexpr std::size_t max_polygon_corners = 10'000;      ///< more take minutes

/// What a file holds besides usable footprints, by features.
struct FootprintCounts {
    std::size_t no_polygons = 0; ///< points, lines, nothing
    std::size_t repaired = 0;    ///< used, though their outlines are not valid
    std::size_t broken = 0;      ///< without area or numbers
    std::size_t too_large = 0;   ///< of over max_polygon_corners
    std::size_t off_earth = 0;   ///< with corners that have no longitude and latitude
    std::size_t no_height = 0;   ///< the attribute is empty or no number of metres
    std::size_t odd_height = 0;  ///< negative, 0 or over max_building_height
};

struct FootprintFile {
    std::vector<FileFootprint> footprints;
    FootprintCounts counts;
};

struct FootprintOptions {
    std::string height; ///< attribute with metres above the ground; empty: none
    /// Whether the corners are transformed to WGS 84; otherwise they stay as in the file.
    bool on_earth = true;
};

/// Reads the polygons of all layers of a vector file: GeoJSON, Shapefile, GeoPackage, FlatGeobuf or
/// KML; with allow_external(true), all formats of GDAL. A feature of several polygons gives several
/// footprints. Errors name the file, what was found and what was expected: no polygons, no such
/// attribute, no coordinate system, files over max_footprint_bytes.
Result<FootprintFile> read_footprints(const std::filesystem::path& path,
                                      const FootprintOptions& options,
                                      const std::stop_token& stop = {});
inline constexpr std::size_t max_footprint_bytes = std::size_t{512} << 20U;

} // namespace reljef::io
