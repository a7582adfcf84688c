#include "engine/terrain/field/earth_horizon.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vector_relational.hpp>

// Scaled by its axes, the ellipsoid is a sphere. It hides what is inside the cone that touches it,
// and beyond the plane through the circle where they touch. This region is convex, so that it holds
// a box if it holds its corners. A narrower cone, which touches a smaller sphere, leaves the
// margin.

namespace reljef::terrain {
namespace {

// Points at a height h above the ellipsoid of axes a and b are outside that of a + h and b + h, or
// at most this part of |h| inside it: the square of the flattening, 1.1e-5, and more.
constexpr double deviation_of_height = 1e-4;

// Scaling changes angles by at most the flattening, 1/298, and so do latitudes of the ellipsoid.
constexpr double max_angle_growth = 1.01;
constexpr double max_turn_of_vertical = 1.0 / 280.0; // radians

// Metres by which the middle of a cell's polygon is below its corners. Where a raster in degrees
// ends nearer to the equator, cells are less than twice as wide as in its middle.
double sagitta(const Placement& placement, double cell) {
    const double width = 2.0 * cell * glm::length(placement.spacing());
    return width * width / (8.0 * geo::radii_of_earth().y);
}

// Whether the samples around a place, an angle (radians at the Earth's centre) away, are those of
// the terrain.
bool is_surrounded(const Placement& placement, glm::ivec2 samples, glm::dvec3 place, double angle) {
    constexpr int count = 64;
    const glm::dvec3 up = placement.up(place);
    const glm::dvec3 north = placement.north(place);
    const glm::dvec3 east = glm::cross(north, up);
    const geo::LocalFrame& frame = *placement.frame();
    const glm::dvec3 center = -frame.local_direction(frame.geocentric_from_local(glm::dvec3(0.0)));
    glm::dvec2 low(std::numeric_limits<double>::infinity());
    glm::dvec2 high = -low;
    std::optional<glm::dvec2> before;
    double step = 0.0;
    for (int i = 0; i <= count; ++i) {
        const double azimuth = 2.0 * std::numbers::pi * i / count;
        const glm::dvec3 aside = std::cos(azimuth) * north + std::sin(azimuth) * east;
        const glm::dvec3 way = std::cos(angle) * up + std::sin(angle) * aside;
        const auto sample = placement.sample_from_world(center + geo::radii_of_earth().x * way);
        if (!sample) {
            return false;
        }
        const glm::dvec2 at(*sample);
        step = before ? std::max(step, glm::distance(at, *before)) : step;
        before = at;
        low = glm::min(low, at);
        high = glm::max(high, at);
    }
    return glm::all(glm::greaterThanEqual(low - step, glm::dvec2(0.0))) &&
           glm::all(glm::lessThanEqual(high + step, glm::dvec2(samples - 1)));
}

bool covers(const Placement& placement, glm::ivec2 samples, glm::dvec3 eye, double angle) {
    const double reach = max_angle_growth * angle + max_turn_of_vertical;
    if (const auto latitudes = placement.latitudes_all_around()) {
        constexpr double pole = 90.0 - 1e-9; // degrees: 0.1 mm
        const double latitude = placement.geodetic_from_world(eye)->latitude;
        const double degrees = glm::degrees(reach);
        return (latitudes->x <= -pole || latitude - degrees > latitudes->x) &&
               (latitudes->y >= pole || latitude + degrees < latitudes->y);
    }
    const double half_width = 0.5 * glm::length(glm::dvec2(samples) * placement.spacing());
    return half_width > angle * geo::radii_of_earth().y &&
           is_surrounded(placement, samples, eye, reach);
}

} // namespace

std::optional<EarthHorizon> EarthHorizon::create(const Placement& placement, glm::ivec2 samples,
                                                 HeightRange drawn, double cell,
                                                 const HorizonView& view) {
    const geo::LocalFrame* const frame = placement.frame();
    if (frame == nullptr) {
        return std::nullopt;
    }
    const double above = placement.geodetic_from_world(view.eye)->height * placement.exaggeration();
    if (!(above > drawn.high + view.near)) {
        return std::nullopt;
    }
    const double height = drawn.low + placement.zero_range().low - sagitta(placement, cell);
    const glm::dvec2 radii =
        geo::radii_of_earth() + (height - deviation_of_height * std::abs(height));
    if (!(radii.y > 0.0)) {
        return std::nullopt;
    }
    EarthHorizon horizon;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 unit(0.0);
        unit[axis] = 1.0;
        const glm::dvec3 geocentric =
            frame->geocentric_from_local(unit) - frame->geocentric_from_local(glm::dvec3(0.0));
        horizon.scaled_from_scene_[axis] = geocentric / glm::dvec3(radii.x, radii.x, radii.y);
    }
    horizon.origin_ =
        frame->geocentric_from_local(glm::dvec3(0.0)) / glm::dvec3(radii.x, radii.x, radii.y);
    horizon.eye_ = horizon.origin_ + horizon.scaled_from_scene_ * view.eye;
    const double length = glm::length(horizon.eye_);
    const double angle = std::asin(std::min(1.0 / length, 1.0)) - max_angle_growth * view.margin;
    if (!(length > 1.0 && angle > 0.0)) {
        return std::nullopt;
    }
    const double radius = length * std::sin(angle);
    if (!covers(placement, samples, view.eye, std::acos(radius / length))) {
        return std::nullopt;
    }
    horizon.down_ = -horizon.eye_ / length;
    horizon.distance_ = length - radius * radius / length;
    horizon.min_cosine_ = std::cos(angle);
    return horizon;
}

bool EarthHorizon::hides(const Box& box) const {
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 corner((i & 1) == 0 ? box.low.x : box.high.x,
                                (i & 2) == 0 ? box.low.y : box.high.y,
                                (i & 4) == 0 ? box.low.z : box.high.z);
        const glm::dvec3 way = origin_ + scaled_from_scene_ * corner - eye_;
        const double along = glm::dot(way, down_);
        if (!(along > distance_ && along > min_cosine_ * glm::length(way))) {
            return false;
        }
    }
    return true;
}

} // namespace reljef::terrain
