#include "engine/cast/earth_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace reljef::cast {
namespace {

// Degrees by which rows may be off the parallels: 0.1 m, and this part of a sample.
constexpr double off_parallel = 1e-6;
constexpr double off_sample = 1e-3;

// Between two longitudes, degrees: the shorter way.
double turn_between(double from, double to) {
    const double turn = to - from;
    return turn - 360.0 * std::round(turn / 360.0);
}

} // namespace

EarthMap::EarthMap(const terrain::Placement& placement, const geo::WrappedRows& rows,
                   const Box& samples)
    : placement_(placement), rows_(rows), largest_(largest_metres(samples)),
      parallels_(parallels(samples)) {
    if (parallels_) {
        // The parallels of a prolate Earth: the radius across the meridian at a pole, and the
        // height.
        const glm::dvec2 radii = geo::radii_of_earth();
        const double above = std::max(placement.exaggeration() * samples.high.z, 0.0) +
                             std::max(placement.zero_range().high, 0.0);
        equator_ = (1.0 + off_sample) * (radii.x * radii.x / radii.y + above) *
                   std::abs(glm::radians(parallels_->column_step));
    }
}

glm::dvec3 EarthMap::world(glm::dvec3 sample) const {
    return placement_.world_from_sample({sample.x, rows_.from_even_row(sample.y), sample.z});
}

std::optional<glm::dvec3> EarthMap::sample(glm::dvec3 world) const {
    auto sample = placement_.sample_from_world(world);
    if (sample) {
        sample->y = rows_.even_row(sample->y);
    }
    return sample;
}

double EarthMap::zero_at(glm::dvec2 sample) const {
    return placement_.zero_at_sample({sample.x, rows_.from_even_row(sample.y)});
}

glm::dvec3 EarthMap::metres_a_sample(Interval rows) const {
    if (!parallels_) {
        return largest_;
    }
    const double first = parallels_->latitude + parallels_->row_step * rows.begin;
    const double last = parallels_->latitude + parallels_->row_step * rows.end;
    const double nearest =
        (first < 0.0) != (last < 0.0) ? 0.0 : std::min(std::abs(first), std::abs(last));
    const double latitude = std::clamp(nearest - off_parallel, 0.0, 90.0);
    return {equator_ * std::cos(glm::radians(latitude)), largest_.y, largest_.z};
}

double EarthMap::columns_around() const {
    return parallels_ ? 360.0 / std::abs(parallels_->column_step) : 0.0;
}

Interval EarthMap::rows_between_poles() const {
    if (!parallels_) {
        constexpr double all = std::numeric_limits<double>::infinity();
        return {-all, all};
    }
    const double last = 90.0 - std::abs(parallels_->row_step);
    const double a = (last - parallels_->latitude) / parallels_->row_step;
    const double b = (-last - parallels_->latitude) / parallels_->row_step;
    return {std::min(a, b), std::max(a, b)};
}

glm::dvec3 EarthMap::largest_metres(const Box& samples) const {
    constexpr int steps = 16;
    constexpr double part = 0.5; // of a sample
    glm::dvec3 metres(0.0, 0.0, placement_.exaggeration());
    for (int i = 0; i <= steps; ++i) {
        for (int j = 0; j <= steps; ++j) {
            const glm::dvec3 at(glm::dvec2(samples.low) + glm::dvec2(samples.size()) *
                                                              glm::dvec2(i, j) /
                                                              static_cast<double>(steps),
                                samples.high.z);
            const glm::dvec3 here = world(at);
            for (int axis = 0; axis < 2; ++axis) {
                glm::dvec3 beside = at;
                beside[axis] += part;
                metres[axis] = std::max(metres[axis], glm::distance(world(beside), here) / part);
            }
        }
    }
    return metres;
}

// Compares places between the first row and the last: at a pole longitudes are arbitrary.
std::optional<EarthMap::Parallels> EarthMap::parallels(const Box& samples) const {
    constexpr int parts = 5;
    const auto place = [&](int i, int j) {
        const glm::dvec2 at = glm::dvec2(samples.low) + glm::dvec2(samples.size()) *
                                                            glm::dvec2(i, j) /
                                                            static_cast<double>(parts);
        return glm::dvec3(at, 0.0);
    };
    const auto geodetic = [&](glm::dvec3 at) { return placement_.geodetic_from_world(world(at)); };
    const auto first = geodetic(place(1, 1));
    const auto last = geodetic(place(1, parts - 1));
    const auto beside = geodetic(place(1, 1) + glm::dvec3(1.0, 0.0, 0.0));
    if (!first || !last || !beside) {
        return std::nullopt;
    }
    Parallels found;
    found.row_step = (last->latitude - first->latitude) / (place(1, parts - 1).y - place(1, 1).y);
    found.latitude = first->latitude - found.row_step * place(1, 1).y;
    found.column_step = turn_between(first->longitude, beside->longitude);
    const double tolerance = std::min(
        off_parallel, off_sample * std::min(std::abs(found.row_step), std::abs(found.column_step)));
    for (int i = 1; i < parts; ++i) {
        for (int j = 1; j < parts; ++j) {
            const glm::dvec3 at = place(i, j);
            const auto here = geodetic(at);
            const auto next = geodetic(at + glm::dvec3(1.0, 0.0, 0.0));
            const double latitude = found.latitude + found.row_step * at.y;
            if (!here || !next || !(std::abs(here->latitude - latitude) <= tolerance) ||
                !(std::abs(turn_between(here->longitude, next->longitude) - found.column_step) <=
                  tolerance)) {
                return std::nullopt;
            }
        }
    }
    return found;
}

} // namespace reljef::cast
