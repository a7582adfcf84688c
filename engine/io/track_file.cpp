#include <cmath>

#include <cpl_conv.h>
#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include "engine/geo/place.h"
#include "engine/io/crs_transform.h"
#include "engine/io/flight_file.h"
#include "engine/io/gdal_dataset.h"

namespace reljef::io {
namespace {

constexpr int most_track_points = 100'000;
constexpr double least_way = 1.0; // metres; nearer points are the same place to a camera

/// The first line of two points or more in a geometry; null where it has none.
const OGRLineString* line_in(const OGRGeometry* geometry) {
    if (geometry == nullptr) {
        return nullptr;
    }
    const OGRwkbGeometryType type = wkbFlatten(geometry->getGeometryType());
    if (type == wkbLineString) {
        const OGRLineString* line = geometry->toLineString();
        return line->getNumPoints() >= 2 ? line : nullptr;
    }
    if (type != wkbMultiLineString && type != wkbGeometryCollection) {
        return nullptr;
    }
    for (const OGRGeometry* part : *geometry->toGeometryCollection()) {
        if (const OGRLineString* line = line_in(part)) {
            return line;
        }
    }
    return nullptr;
}

/// A point of a line in degrees; the height where the line has heights.
struct TrackPoint {
    glm::dvec2 place{0.0}; // longitude, latitude
    std::optional<double> height;
};

std::optional<std::vector<TrackPoint>> points_of(const OGRLineString& line) {
    std::vector<glm::dvec2> places;
    places.reserve(static_cast<std::size_t>(line.getNumPoints()));
    for (int i = 0; i < line.getNumPoints(); ++i) {
        places.emplace_back(line.getX(i), line.getY(i));
    }
    if (const OGRSpatialReference* crs = line.getSpatialReference()) {
        char* text = nullptr;
        crs->exportToWkt(&text);
        const std::string wkt = text != nullptr ? text : "";
        CPLFree(text);
        const auto transform = CrsTransform::create(wkt, wgs84_degrees);
        if (!transform) {
            return std::nullopt;
        }
        transform->apply(places);
    }
    std::vector<TrackPoint> points;
    for (int i = 0; i < line.getNumPoints(); ++i) {
        const bool has_height = line.Is3D() != 0 && std::isfinite(line.getZ(i));
        points.push_back({places[static_cast<std::size_t>(i)],
                          has_height ? std::optional(line.getZ(i)) : std::nullopt});
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
        GeodeticKey key;
        key.latitude = point.place.y;
        key.longitude = point.place.x;
        key.height = point.height;
        if (!keys.empty()) {
            const double way =
                geo::geodesic_distance({keys.back().latitude, keys.back().longitude, 0.0},
                                       {key.latitude, key.longitude, 0.0});
            if (way < least_way) {
                continue;
            }
            key.time = keys.back().time + way / metres_a_second;
        }
        keys.push_back(key);
    }
    return keys;
}

const OGRLineString* first_line(GDALDataset& dataset, OGRFeatureUniquePtr& holder) {
    for (OGRLayer* layer : dataset.GetLayers()) {
        while (OGRFeature* feature = layer->GetNextFeature()) {
            holder.reset(feature);
            if (const OGRLineString* line = line_in(feature->GetGeometryRef())) {
                return line;
            }
        }
    }
    return nullptr;
}

} // namespace

Result<std::vector<GeodeticKey>> read_track(const std::filesystem::path& path,
                                            double metres_a_second) {
    check(metres_a_second > 0.0, "read_track needs a speed");
    const std::string name = path.string();
    register_drivers();
    const GdalMessages messages;
    const CPLConfigOptionSetter heights("GPX_ELE_AS_25D", "YES", false);
    const Dataset dataset(
        GDALDataset::Open(name.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
    if (dataset == nullptr) {
        return Error{fmt::format("{}: cannot be opened as a path{}, a path file (TOML) or a file "
                                 "with a line (GPX, KML, GeoJSON) was expected",
                                 name, messages.reason())};
    }
    OGRFeatureUniquePtr holder;
    const OGRLineString* line = first_line(*dataset, holder);
    if (line == nullptr) {
        return Error{fmt::format("{}: holds no line of two points or more{}, one was expected",
                                 name, messages.reason())};
    }
    if (line->getNumPoints() > most_track_points) {
        return Error{fmt::format("{}: its line has {} points, at most {} were expected", name,
                                 line->getNumPoints(), most_track_points)};
    }
    const auto points = points_of(*line);
    if (!points) {
        return Error{fmt::format("{}: its coordinate system does not lead to WGS 84, one that does "
                                 "was expected",
                                 name)};
    }
    return keys_along(*points, metres_a_second, name);
}

} // namespace reljef::io
