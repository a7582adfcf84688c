#include "engine/terrain/measure/profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "engine/geo/place.h"

namespace reljef::terrain {

ProfileSummary summarize(std::span<const ProfilePoint> points) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    ProfileSummary summary;
    summary.lowest = none;
    summary.highest = none;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double height = points[i].height;
        summary.missing += std::isnan(height) ? 1 : 0;
        summary.lowest = std::fmin(summary.lowest, height); // ignores NaN
        summary.highest = std::fmax(summary.highest, height);
        if (i == 0) {
            continue;
        }
        const double way = points[i].distance - points[i - 1].distance;
        const double rise = height - points[i - 1].height;
        const double known_rise = std::isnan(rise) ? 0.0 : rise;
        summary.distance += way;
        summary.over_ground += std::hypot(way, known_rise);
        summary.climb += std::max(known_rise, 0.0);
        summary.descent += std::max(-known_rise, 0.0);
    }
    return summary;
}

Result<std::vector<geo::Geodetic>> geodesic_places(const geo::Geodetic& from,
                                                   const geo::Geodetic& to, double step) {
    const auto is_place = [](const geo::Geodetic& place) {
        return std::abs(place.latitude) <= 90.0 && std::isfinite(place.longitude) &&
               std::isfinite(place.height);
    };
    if (!is_place(from) || !is_place(to)) {
        return Error{"profile: a place that is no latitude and longitude found"};
    }
    const geo::Geodesic way = geo::geodesic_between(from, to);
    const double steps = step > 0.0 ? std::max(1.0, std::ceil(way.distance / step)) : 0.0;
    if (!(steps >= 1.0) || !(steps < max_profile_points)) {
        return Error{fmt::format("profile: {} m between points found, a step with at most {} "
                                 "points on {:.0f} m was expected",
                                 step, max_profile_points, way.distance)};
    }
    const int count = static_cast<int>(steps);
    std::vector<geo::Geodetic> places;
    for (int i = 0; i < count; ++i) {
        const double share = static_cast<double>(i) / count;
        places.push_back(geo::geodesic_end(from, way.azimuth_start, share * way.distance));
        places.back().height = std::lerp(from.height, to.height, share);
    }
    places.front() = from;
    places.push_back(to);
    return places;
}

} // namespace reljef::terrain
