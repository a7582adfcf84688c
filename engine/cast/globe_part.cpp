#include "engine/cast/globe_part.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "engine/core/check.h"
#include "engine/geo/georeference.h"

namespace reljef::cast {
namespace {

// All places in directions up to an angle from an eye's, between two distances from the centre of
// the Earth. Along its axis the Earth is stretched to a sphere of radius 1: lines stay straight.
struct Cap {
    glm::dvec3 middle{0.0}; // unit: below the eye
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

// From the centre of the stretched Earth. `heights`: metres above the ellipsoid.
Interval stretched(Interval heights) {
    const double polar = geo::radii_of_earth().y;
    return {1.0 + std::min(heights.begin, 0.0) / polar, 1.0 + std::max(heights.end, 0.0) / polar};
}

// As far as a ray that touches the lowest ground meets the highest. `to_lowest`: the angle from the
// middle to where it touches. `heights`: metres above the ellipsoid.
Cap cap_around(glm::dvec3 middle, double to_lowest, Interval heights) {
    const double polar = geo::radii_of_earth().y;
    const Interval radii = stretched(heights);
    const double off_ground = std::max(-heights.begin, heights.end) / polar;
    return {middle,
            to_lowest + std::acos(radii.begin / radii.end) + off_ground * turn_of_vertical(),
            radii};
}

// Metres above the ellipsoid.
Interval heights_of(const terrain::Placement& placement, const Box& samples) {
    const terrain::HeightRange zeros = placement.zero_range();
    const double exaggeration = placement.exaggeration();
    return {exaggeration * samples.low.z + zeros.low, exaggeration * samples.high.z + zeros.high};
}

// How far a cap reaches along a vector, in both directions.
Interval extent_of(const Cap& cap, glm::dvec3 along) {
    const double length = glm::length(along);
    const double angle = std::acos(std::clamp(glm::dot(along, cap.middle) / length, -1.0, 1.0));
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
    double middle = 0.0; // latitude, degrees
    double south = -90.0;
    double north = 90.0;
    double half_width = 360.0; // longitudes beside the middle's; twice around
};

Extent seen_extent(const Cap& cap) {
    const double eye = std::asin(std::clamp(cap.middle.z, -1.0, 1.0));
    constexpr double quarter = 0.5 * std::numbers::pi;
    Extent found;
    found.middle = latitude_of(eye);
    if (eye + cap.angle < quarter) {
        found.north = latitude_of(eye + cap.angle);
    }
    if (eye - cap.angle > -quarter) {
        found.south = latitude_of(eye - cap.angle);
    }
    if (std::abs(eye) + cap.angle < quarter) {
        found.half_width = glm::degrees(std::asin(std::sin(cap.angle) / std::cos(eye)));
    }
    return found;
}

// Ground that is so near to a pole reaches it: 0.1 mm.
constexpr double pole = 90.0 - 1e-9; // degrees

GlobePart part_of(const Cap& cap, const terrain::Placement& placement, const geo::WrappedRows& rows,
                  const Box& samples) {
    const Extent seen = seen_extent(cap);
    const glm::dvec2 ground = *placement.latitudes_all_around();
    const double longitude = glm::degrees(std::atan2(cap.middle.y, cap.middle.x));
    const auto sample_at = [&](double latitude) {
        const double inside = std::clamp(latitude, ground.x, ground.y);
        const auto world = placement.world_from_geodetic({inside, longitude, 0.0});
        const auto sample = world ? placement.sample_from_world(*world) : std::nullopt;
        check(sample.has_value(), "a globe in degrees has a sample at each place");
        return glm::dvec2(sample->x, rows.even_row(sample->y));
    };
    const double col = sample_at(seen.middle).x;
    const double half_width = *placement.columns_all_around() * seen.half_width / 360.0;
    const double first = seen.north < ground.y ? sample_at(seen.north).y : samples.low.y;
    const double last = seen.south > ground.x ? sample_at(seen.south).y : samples.high.y;
    GlobePart part;
    part.local = local_box(cap, *placement.frame());
    part.has_north_pole = seen.north > pole && ground.y > pole;
    part.has_south_pole = seen.south < -pole && ground.x < -pole;
    part.samples.add(glm::dvec3(col - half_width, first, samples.low.z));
    part.samples.add(glm::dvec3(col + half_width, std::max(last, first + 1.0), samples.high.z));
    return part;
}

// `way`: unit vector. Half of the Earth, where the rays do not all meet the lowest ground.
Cap cap_along(glm::dvec3 place, glm::dvec3 way, double radius, Interval heights) {
    const glm::dvec3 beside = place - glm::dot(place, way) * way;
    const double off = glm::length(beside);
    const double lowest = stretched(heights).begin;
    if (!(off + radius < lowest)) {
        return cap_around(-way, 0.5 * std::numbers::pi, heights);
    }
    // Along any line on the picture, ground is stretched as along the one to its border, at most.
    const glm::dvec3 met = beside - std::sqrt(lowest * lowest - off * off) * way;
    return cap_around(glm::normalize(met),
                      std::asin((off + radius) / lowest) - std::asin(off / lowest), heights);
}

} // namespace

std::optional<GlobePart> globe_part_from(glm::dvec3 eye, const terrain::Placement& placement,
                                         const geo::WrappedRows& rows, const Box& samples) {
    const Interval heights = heights_of(placement, samples);
    const glm::dvec3 scaled = placement.frame()->geocentric_from_local(eye) / radii_of_axes();
    const double lowest = stretched(heights).begin;
    const double distance = glm::length(scaled);
    if (!(lowest > 0.0 && distance > lowest)) {
        return std::nullopt;
    }
    const Cap cap = cap_around(scaled / distance, std::acos(lowest / distance), heights);
    return part_of(cap, placement, rows, samples);
}

GlobePart globe_part_along(const ParallelRays& rays, const terrain::Placement& placement,
                           const geo::WrappedRows& even_rows, const Box& samples) {
    const geo::LocalFrame& frame = *placement.frame();
    const auto scaled = [&](glm::dvec3 local) {
        return frame.geocentric_from_local(local) / radii_of_axes();
    };
    const glm::dvec3 way = glm::normalize(scaled(rays.middle.direction) - scaled(glm::dvec3(0.0)));
    const Cap cap =
        cap_along(scaled(rays.middle.origin), way, rays.radius / geo::radii_of_earth().y,
                  heights_of(placement, samples));
    return part_of(cap, placement, even_rows, samples);
}

} // namespace reljef::cast
