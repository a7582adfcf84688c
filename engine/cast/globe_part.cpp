#include "engine/cast/globe_part.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "engine/geo/georeference.h"

namespace reljef::cast {
namespace {

// All places in directions up to an angle from an eye's, between two distances from the centre of
// the Earth. Along its axis the Earth is stretched to a sphere of radius 1: lines stay straight.
struct Cap {
    glm::dvec3 to_eye{0.0}; // unit
    double angle = 0.0;     // radians
    Interval radii;
};

glm::dvec3 radii_of_axes() {
    const glm::dvec2 radii = geo::radii_of_earth();
    return {radii.x, radii.x, radii.y};
}

// Of a metre above the ground, in radii of the Earth: how far the vertical leads from the radius.
double turn_of_vertical() {
    const glm::dvec2 radii = geo::radii_of_earth();
    return 2.0 * (1.0 - radii.y / radii.x);
}

// As far as a ray that touches the lowest ground meets the highest. `heights`: metres above the
// ellipsoid.
std::optional<Cap> seen_cap(glm::dvec3 eye, Interval heights) {
    const glm::dvec3 scaled = eye / radii_of_axes();
    const double polar = geo::radii_of_earth().y;
    const Interval radii{1.0 + std::min(heights.begin, 0.0) / polar,
                         1.0 + std::max(heights.end, 0.0) / polar};
    const double distance = glm::length(scaled);
    if (!(radii.begin > 0.0 && distance > radii.begin)) {
        return std::nullopt;
    }
    const double off_ground = std::max(-heights.begin, heights.end) / polar;
    return Cap{scaled / distance,
               std::acos(radii.begin / distance) + std::acos(radii.begin / radii.end) +
                   off_ground * turn_of_vertical(),
               radii};
}

// How far a cap reaches along a vector, in both directions.
Interval extent_of(const Cap& cap, glm::dvec3 along) {
    const double length = glm::length(along);
    const double angle = std::acos(std::clamp(glm::dot(along, cap.to_eye) / length, -1.0, 1.0));
    const double nearest = std::cos(std::max(angle - cap.angle, 0.0));
    const double farthest = std::cos(std::min(angle + cap.angle, std::numbers::pi));
    return {length * farthest * (farthest < 0.0 ? cap.radii.end : cap.radii.begin),
            length * nearest * (nearest > 0.0 ? cap.radii.end : cap.radii.begin)};
}

Box local_box(const Cap& cap, const geo::LocalFrame& frame) {
    const glm::dvec3 origin = frame.geocentric_from_local(glm::dvec3(0.0));
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 unit(0.0);
        unit[axis] = 1.0;
        const glm::dvec3 along = frame.geocentric_from_local(unit) - origin;
        const Interval extent = extent_of(cap, along * radii_of_axes());
        const double zero = glm::dot(along, origin);
        box.low[axis] = extent.begin - zero;
        box.high[axis] = extent.end - zero;
    }
    return box;
}

// Degrees, of a latitude on the stretched Earth.
double latitude_of(double reduced) {
    const glm::dvec2 radii = geo::radii_of_earth();
    return glm::degrees(std::atan(std::tan(reduced) * radii.x / radii.y));
}

struct Extent {
    double south = -90.0; // degrees
    double north = 90.0;
    double half_width = 360.0; // longitudes beside the eye's; twice around
};

Extent seen_extent(const Cap& cap) {
    const double eye = std::asin(std::clamp(cap.to_eye.z, -1.0, 1.0));
    constexpr double pole = 0.5 * std::numbers::pi;
    Extent found;
    if (eye + cap.angle < pole) {
        found.north = latitude_of(eye + cap.angle);
    }
    if (eye - cap.angle > -pole) {
        found.south = latitude_of(eye - cap.angle);
    }
    if (std::abs(eye) + cap.angle < pole) {
        found.half_width = glm::degrees(std::asin(std::sin(cap.angle) / std::cos(eye)));
    }
    return found;
}

} // namespace

std::optional<GlobePart> globe_part(const terrain::Placement& placement, glm::dvec3 eye,
                                    const Box& samples, Interval rows) {
    const geo::LocalFrame& frame = *placement.frame();
    const terrain::HeightRange zeros = placement.zero_range();
    const double exaggeration = placement.exaggeration();
    const auto cap =
        seen_cap(frame.geocentric_from_local(eye), {exaggeration * samples.low.z + zeros.low,
                                                    exaggeration * samples.high.z + zeros.high});
    const auto below_eye = placement.sample_from_world(eye);
    if (!cap || !below_eye) {
        return std::nullopt;
    }
    const Extent seen = seen_extent(*cap);
    const glm::dvec2 ground = *placement.latitudes_all_around();
    const double longitude = placement.geodetic_from_world(eye)->longitude;
    const auto row_at = [&](double latitude) {
        const auto world = placement.world_from_geodetic({latitude, longitude, 0.0});
        const auto sample = world ? placement.sample_from_world(*world) : std::nullopt;
        return sample ? sample->y : std::numeric_limits<double>::quiet_NaN();
    };
    const double first = seen.north < ground.y ? row_at(seen.north) : samples.low.y;
    const double last = seen.south > ground.x ? row_at(seen.south) : samples.high.y;
    if (!(first >= rows.begin && last <= rows.end && first < last)) {
        return std::nullopt;
    }
    const double half_width = *placement.columns_all_around() * seen.half_width / 360.0;
    GlobePart part;
    part.local = local_box(*cap, frame);
    part.samples.add(glm::dvec3(below_eye->x - half_width, first, samples.low.z));
    part.samples.add(glm::dvec3(below_eye->x + half_width, last, samples.high.z));
    return part;
}

} // namespace reljef::cast
