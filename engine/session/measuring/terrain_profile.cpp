#include "engine/session/measuring/terrain_profile.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <fmt/format.h>

namespace reljef::session {
namespace {

double finest_spacing(const io::TileSet& tiles) {
    double spacing = std::numeric_limits<double>::infinity();
    for (const io::TileFile& file : tiles.files()) {
        spacing = std::min({spacing, file.spacing.x, file.spacing.y});
    }
    return spacing;
}

bool is_in_area(glm::dvec2 place, const std::optional<geo::GeodeticArea>& area) {
    if (!area) {
        return true;
    }
    const double east_of_west = place.y - area->west;
    const double turned = east_of_west - 360.0 * std::floor(east_of_west / 360.0);
    return place.x >= area->south && place.x <= area->north && turned <= area->east - area->west;
}

} // namespace

Result<TerrainProfile> profile_of(const HeightSource& source, const ProfileRequest& request,
                                  const std::string& name, const std::stop_token& stop) {
    const double step = request.step.value_or(0.5 * finest_spacing(source.tiles));
    const auto way = terrain::geodesic_places({request.from.x, request.from.y, 0.0},
                                              {request.to.x, request.to.y, 0.0}, step);
    if (!way) {
        return way.error();
    }
    TerrainProfile profile;
    for (const geo::Geodetic& place : *way) {
        profile.places.emplace_back(place.latitude, place.longitude);
    }
    auto heights = source.tiles.heights(profile.places, stop);
    if (stop.stop_requested()) {
        return Error{"interrupted"};
    }
    const double whole = geo::geodesic_distance(way->front(), way->back());
    const double last = static_cast<double>(profile.places.size() - 1);
    bool is_on_terrain = false;
    for (std::size_t i = 0; i < profile.places.size(); ++i) {
        const io::HeightSample& answer = heights.answers[i];
        const bool is_inside = answer.kind != io::HeightSample::Kind::outside &&
                               is_in_area(profile.places[i], source.area);
        const bool has_height = is_inside && answer.kind == io::HeightSample::Kind::height;
        is_on_terrain = is_on_terrain || is_inside;
        profile.points.push_back(
            {whole * static_cast<double>(i) / last,
             has_height ? answer.height : std::numeric_limits<double>::quiet_NaN()});
    }
    profile.errors = std::move(heights.errors);
    if (!is_on_terrain) {
        return Error{fmt::format("the way from {},{} to {},{} lies beside {}, one over it was "
                                 "expected",
                                 request.from.x, request.from.y, request.to.x, request.to.y, name)};
    }
    return profile;
}

std::string profile_csv(const TerrainProfile& profile) {
    std::string text = "distance,latitude,longitude,height\n";
    for (std::size_t i = 0; i < profile.points.size(); ++i) {
        const terrain::ProfilePoint& point = profile.points[i];
        fmt::format_to(std::back_inserter(text), "{:.3f},{:.9f},{:.9f},", point.distance,
                       profile.places[i].x, profile.places[i].y);
        text += std::isnan(point.height) ? "nan\n" : fmt::format("{:.3f}\n", point.height);
    }
    return text;
}

} // namespace reljef::session
