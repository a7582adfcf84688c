#include "engine/io/files/tile_grid.h"

#include <algorithm>
#include <cmath>

namespace reljef::io {

double resolution(glm::dvec2 spacing) {
    constexpr double same_resolution = 1.01; // ratio of spacings
    return std::round(0.5 * std::log(spacing.x * spacing.y) / std::log(same_resolution));
}

double metres_between(glm::dvec2 a, glm::dvec2 b) {
    const auto latitude = [](double degrees) { return std::clamp(degrees, -90.0, 90.0); };
    return geo::geodesic_distance({latitude(a.y), a.x, 0.0}, {latitude(b.y), b.x, 0.0});
}

} // namespace reljef::io
