#include "engine/io/imagery/degree_box.h"

#include <cmath>

#include <glm/common.hpp>

#include "engine/io/raster/georeferencing.h"

namespace reljef::io {
std::vector<glm::dvec2> places_over(const PlaceAt& place_at, const std::string& crs) {
    constexpr int side = 8;
    std::vector<glm::dvec2> places;
    for (int row = 0; row <= side; ++row) {
        for (int col = 0; col <= side; ++col) {
            places.push_back(place_at(glm::dvec2(col, row) / static_cast<double>(side)));
        }
    }
    if (crs != wgs84_degrees) {
        const auto transform = CrsTransform::create(crs, wgs84_degrees);
        if (!transform) {
            return {};
        }
        transform->apply(places);
    }
    const double middle = places[middle_of_places].x;
    for (glm::dvec2& place : places) {
        place.x += 360.0 * std::round((middle - place.x) / 360.0);
    }
    return std::isnan(middle) ? std::vector<glm::dvec2>() : places;
}

std::vector<glm::dvec2> places_over(GDALDataset& image) {
    std::vector<std::string> ignored;
    const auto affine = affine_of(image);
    const auto crs = affine ? horizontal_crs(image, ignored) : std::nullopt;
    if (!crs || crs->IsLocal() != 0) {
        return {};
    }
    const glm::dvec2 size(image.GetRasterXSize(), image.GetRasterYSize());
    return places_over([&](glm::dvec2 part) { return affine->crs_from_pixel(part * size); },
                       wkt_of(*crs));
}

DegreeBox padded_box(std::span<const glm::dvec2> degrees) {
    glm::dvec2 low(1e9);
    glm::dvec2 high(-1e9);
    for (const glm::dvec2 point : degrees) {
        low = std::isnan(point.x) ? low : glm::min(low, point);
        high = std::isnan(point.x) ? high : glm::max(high, point);
    }
    const glm::dvec2 margin = 0.1 * (high - low);
    return {low.x - margin.x, low.y - margin.y, high.x + margin.x, high.y + margin.y};
}

std::vector<double> turns_to_meet(const DegreeBox& box, const DegreeBox& other) {
    std::vector<double> turns;
    for (const double turn : {0.0, -360.0, 360.0}) {
        if (box[0] + turn <= other[2] && box[2] + turn >= other[0] && box[1] <= other[3] &&
            box[3] >= other[1]) {
            turns.push_back(turn);
        }
    }
    return turns;
}

} // namespace reljef::io
