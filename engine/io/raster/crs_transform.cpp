#include "engine/io/raster/crs_transform.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace reljef::io {

DegreeBox united(const DegreeBox& a, const DegreeBox& b) {
    return {std::min(a[0], b[0]), std::min(a[1], b[1]), std::max(a[2], b[2]), std::max(a[3], b[3])};
}

OGRSpatialReference crs_from_text(const std::string& text) {
    OGRSpatialReference crs;
    crs.SetFromUserInput(text.c_str());
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return crs;
}

std::string wkt_of(const OGRSpatialReference& crs, const char* format) {
    char* text = nullptr;
    const std::array<const char*, 2> options{format, nullptr};
    crs.exportToWkt(&text, options.data());
    std::string wkt = text != nullptr ? text : "";
    CPLFree(text);
    return wkt;
}

bool is_same_crs(const std::string& a, const std::string& b) {
    const OGRSpatialReference other = crs_from_text(b);
    return a == b || crs_from_text(a).IsSame(&other) != 0;
}

namespace {

// Of codes that PROJ knows.
bool is_geocentric(const std::string& code) {
    OGRSpatialReference named;
    return named.SetFromUserInput(code.c_str(),
                                  OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get()) ==
               OGRERR_NONE &&
           named.IsGeocentric() != 0;
}

} // namespace

std::optional<std::string> false_code_of(const OGRSpatialReference& crs) {
    if (crs.IsGeocentric() != 0) {
        return std::nullopt;
    }
    for (const char* const part : {static_cast<const char*>(nullptr), "GEOGCS"}) {
        const char* const authority = crs.GetAuthorityName(part);
        const char* const number = crs.GetAuthorityCode(part);
        if (authority != nullptr && number != nullptr) {
            std::string code = std::string(authority) + ":" + number;
            if (is_geocentric(code)) {
                return code;
            }
        }
    }
    return std::nullopt;
}

std::optional<CrsTransform> CrsTransform::create(const OGRSpatialReference& from,
                                                 const OGRSpatialReference& to,
                                                 const std::optional<DegreeBox>& area) {
    if (false_code_of(from) || false_code_of(to)) {
        return std::nullopt;
    }
    OGRCoordinateTransformationOptions options;
    if (area) {
        const auto& [west, south, east, north] = *area;
        options.SetAreaOfInterest(west, south, east, north);
    }
    Transformation transform(OGRCreateCoordinateTransformation(&from, &to, options),
                             &OGRCoordinateTransformation::DestroyCT);
    return transform != nullptr ? std::optional(CrsTransform(std::move(transform))) : std::nullopt;
}

std::optional<CrsTransform> CrsTransform::create(const std::string& from, const std::string& to,
                                                 const std::optional<DegreeBox>& area) {
    return create(crs_from_text(from), crs_from_text(to), area);
}

void CrsTransform::apply(std::span<glm::dvec2> points) const {
    std::vector<double> x(points.size());
    std::vector<double> y(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        x[i] = points[i].x;
        y[i] = points[i].y;
    }
    std::vector<int> done(points.size(), 0);
    transform_->Transform(static_cast<int>(points.size()), x.data(), y.data(), nullptr,
                          done.data());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const bool good = done[i] != 0 && std::isfinite(x[i]) && std::isfinite(y[i]);
        points[i] =
            good ? glm::dvec2(x[i], y[i]) : glm::dvec2(std::numeric_limits<double>::quiet_NaN());
    }
}

} // namespace reljef::io
