#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace reljef::test {

/// A GeoJSON feature. `rings`: as in "[[[0,0],[1,0],[1,1],[0,0]]]"; `properties`: as in "\"h\":3".
inline std::string polygon_feature(const std::string& rings, const std::string& properties = "") {
    return R"({"type":"Feature","properties":{)" + properties +
           R"(},"geometry":{"type":"Polygon","coordinates":)" + rings + "}}";
}

/// A GeoJSON file; `crs`: such as "EPSG::3857", or empty for WGS 84.
inline std::string footprints_text(const std::vector<std::string>& features,
                                   const std::string& crs = "") {
    std::string text = R"({"type":"FeatureCollection",)";
    if (!crs.empty()) {
        text += R"("crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:)" + crs + "\"}},";
    }
    text += "\"features\":[";
    for (std::size_t i = 0; i < features.size(); ++i) {
        text += (i > 0 ? ",\n" : "\n") + features[i];
    }
    return text + "]}";
}

/// The ring of a rectangle, for polygon_feature().
inline std::string rectangle(double west, double south, double east, double north) {
    return fmt::format("[[{0:.9f},{1:.9f}],[{2:.9f},{1:.9f}],[{2:.9f},{3:.9f}],[{0:.9f},{3:.9f}],"
                       "[{0:.9f},{1:.9f}]]",
                       west, south, east, north);
}

} // namespace reljef::test
