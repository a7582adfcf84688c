#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include <cpl_conv.h>
#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include "engine/core/geometry.h"
#include "engine/geo/place.h"
#include "engine/io/checks/kml_archive.h"
#include "engine/io/checks/xml_elements.h"
#include "engine/io/formats/flight_file.h"
#include "engine/io/raster/crs_transform.h"
#include "engine/io/raster/gdal_dataset.h"

namespace reljef::io {
namespace {

constexpr std::size_t max_track_points = 100'000;
constexpr std::uintmax_t max_track_bytes = std::uintmax_t{64} << 20U;
constexpr double min_step = 1.0; // metres; skips nearer points

using Segments = std::vector<const OGRLineString*>;

Segments segments_in(const OGRGeometry* geometry) {
    if (geometry == nullptr) {
        return {};
    }
    const OGRwkbGeometryType type = wkbFlatten(geometry->getGeometryType());
    if (type == wkbLineString) {
        return {geometry->toLineString()};
    }
    if (type != wkbMultiLineString && type != wkbGeometryCollection) {
        return {};
    }
    Segments segments;
    for (const OGRGeometry* part : *geometry->toGeometryCollection()) {
        const Segments more = segments_in(part);
        segments.insert(segments.end(), more.begin(), more.end());
    }
    return segments;
}

std::size_t points_in(const Segments& segments) {
    std::size_t count = 0;
    for (const OGRLineString* segment : segments) {
        count += static_cast<std::size_t>(segment->getNumPoints());
    }
    return count;
}

struct TrackPoint {
    glm::dvec2 place{0.0}; // longitude, latitude
    std::optional<double> height;
};

/// Absent if the segments' CRS does not lead to WGS 84.
std::optional<std::vector<TrackPoint>> points_of(const Segments& segments) {
    std::vector<TrackPoint> points;
    std::vector<glm::dvec2> places;
    for (const OGRLineString* line : segments) {
        for (int i = 0; i < line->getNumPoints(); ++i) {
            const bool has_height = line->Is3D() != 0 && std::isfinite(line->getZ(i));
            points.push_back({{}, has_height ? std::optional(line->getZ(i)) : std::nullopt});
            places.emplace_back(line->getX(i), line->getY(i));
        }
    }
    if (const OGRSpatialReference* crs = segments.front()->getSpatialReference()) {
        const auto transform = CrsTransform::create(wkt_of(*crs, "FORMAT=DEFAULT"), wgs84_degrees);
        if (!transform) {
            return std::nullopt;
        }
        transform->apply(places);
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        points[i].place = places[i];
    }
    return points;
}

Result<std::vector<GeodeticKey>> keys_along(const std::vector<TrackPoint>& points,
                                            double metres_a_second, const std::string& name) {
    std::vector<GeodeticKey> keys;
    for (const TrackPoint& point : points) {
        if (!(std::abs(point.place.y) <= 90.0 && std::abs(point.place.x) <= 720.0)) {
            return Error{fmt::format("{}: its line has a point at {},{}, latitudes from -90 to 90 "
                                     "and longitudes in degrees were expected",
                                     name, point.place.y, point.place.x)};
        }
        if (std::abs(point.height.value_or(0.0)) > max_world_coordinate) {
            return Error{fmt::format("{}: its line has a height of {} m, at most {} m was expected",
                                     name, *point.height, max_world_coordinate)};
        }
        GeodeticKey key;
        key.latitude = point.place.y;
        key.longitude = point.place.x;
        key.height = point.height;
        if (!keys.empty()) {
            const double way =
                geo::geodesic_distance({keys.back().latitude, keys.back().longitude, 0.0},
                                       {key.latitude, key.longitude, 0.0});
            if (way < min_step) {
                continue;
            }
            key.time = keys.back().time + way / metres_a_second;
        }
        keys.push_back(key);
    }
    return keys;
}

/// The first feature with at least two points.
struct FoundTrack {
    OGRFeatureUniquePtr feature; ///< owns the segments
    Segments segments;
    int tracks = 0; ///< number of such features in the file
};

FoundTrack find_track(GDALDataset& dataset) {
    FoundTrack found;
    for (OGRLayer* layer : dataset.GetLayers()) {
        while (OGRFeatureUniquePtr feature{layer->GetNextFeature()}) {
            Segments segments = segments_in(feature->GetGeometryRef());
            if (points_in(segments) >= 2 && found.tracks++ == 0) {
                found.feature = std::move(feature);
                found.segments = std::move(segments);
            }
        }
    }
    return found;
}

/// The name by which GDAL opens it.
Result<std::string> checked_track(const std::filesystem::path& path) {
    const std::string name = path.string();
    std::error_code code;
    if (std::filesystem::exists(path, code) && !std::filesystem::is_regular_file(path, code)) {
        return Error{fmt::format("{}: is no regular file, a path was expected", name)};
    }
    const std::uintmax_t size = std::filesystem::file_size(path, code);
    if (!code && size > max_track_bytes) {
        return Error{fmt::format("{}: {} bytes found, a path of at most {} was expected", name,
                                 size, max_track_bytes)};
    }
    auto lines = vector_file_name(path, max_track_bytes);
    if (!lines) {
        return lines;
    }
    const auto good = check_xml(*lines, path);
    return good ? std::move(lines) : good.error();
}

} // namespace

Result<Flight> read_track(const std::filesystem::path& path, double metres_a_second) {
    check(metres_a_second > 0.0, "read_track needs a speed");
    const std::string name = path.string();
    register_drivers();
    const GdalMessages messages;
    const auto file = checked_track(path);
    if (!file) {
        return file.error();
    }
    const CPLConfigOptionSetter heights("GPX_ELE_AS_25D", "YES", false);
    constexpr std::array<const char*, 5> formats{"GPX", "LIBKML", "KML", "GeoJSON", nullptr};
    const Dataset dataset(GDALDataset::Open(
        file->c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, formats.data()));
    if (dataset == nullptr) {
        return Error{fmt::format("{}: cannot be opened as a path{}, a path file (TOML) or a file "
                                 "with a line (GPX, KML, GeoJSON) was expected",
                                 name, messages.reason())};
    }
    const FoundTrack track = find_track(*dataset);
    if (track.tracks == 0) {
        return Error{fmt::format("{}: holds no line of two points or more{}, one was expected",
                                 name, messages.reason())};
    }
    if (const std::size_t count = points_in(track.segments); count > max_track_points) {
        return Error{fmt::format("{}: its line has {} points, at most {} were expected", name,
                                 count, max_track_points)};
    }
    const auto points = points_of(track.segments);
    if (!points) {
        return Error{fmt::format("{}: its coordinate system does not lead to WGS 84, one that does "
                                 "was expected",
                                 name)};
    }
    auto keys = keys_along(*points, metres_a_second, name);
    if (!keys) {
        return keys.error();
    }
    Flight flight{std::move(*keys), {}};
    if (track.tracks > 1) {
        flight.notes.push_back(
            fmt::format("{}: holds {} lines, the first is flown", name, track.tracks));
    }
    return flight;
}

} // namespace reljef::io
