#include "engine/cast/sample_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/core/parallel_for.h"
#include "engine/geo/cubic.h"

namespace reljef::cast {
namespace {

constexpr double radius_of_earth = 6.4e6; // metres

// Zeros along a side: a few kilometres apart where the Earth bends visibly, as the geoid is smooth
// over tens of them.
constexpr int zero_count = 65;

bool is_within(const terrain::SamplePolynomial& polynomial, const SampleMap::Tolerance& tolerance,
               glm::dvec3 eye) {
    const auto checks = polynomial.checks();
    return std::all_of(checks.begin(), checks.end(), [&](const auto& check) {
        return check.error <= tolerance.near + tolerance.a_metre * glm::distance(check.world, eye);
    });
}

// Polynomials do not follow the closer rows at a pole. `rows`: without those.
bool keeps_to(const terrain::SamplePolynomial& polynomial, Interval rows) {
    for (const double x : {-1.0, 1.0}) {
        for (const double y : {-1.0, 1.0}) {
            const double row = polynomial.at_local({x, y, 0.0}).y;
            if (!(row >= rows.begin && row <= rows.end)) {
                return false;
            }
        }
    }
    return true;
}

// The sample of a place in the box of a polynomial.
std::optional<glm::dvec3> found(const std::optional<terrain::SamplePolynomial>& polynomial,
                                glm::dvec3 place) {
    if (!polynomial) {
        return std::nullopt;
    }
    const glm::dvec3 inside = polynomial->local(place);
    const glm::dvec3 size = glm::abs(inside);
    return std::max({size.x, size.y, size.z}) <= 1.0 ? std::optional(polynomial->at_local(inside))
                                                     : std::nullopt;
}

} // namespace

SampleMap::SampleMap(const EarthMap& map, const Ground& ground, const Tolerance& tolerance,
                     unsigned threads)
    : map_(map), around_(map.placement().columns_all_around().value_or(0.0)),
      middle_(ground.samples.center().x) {
    constexpr int few_halvings = 3;
    constexpr int many_halvings = 7;
    const terrain::Placement& placement = map.placement();
    const bool has_geoid = placement.has_geoid();
    near_ = fitted(placement, ground, tolerance, has_geoid ? many_halvings : few_halvings);
    if (has_geoid) {
        far_ = fitted(placement.without_geoid(), ground, tolerance, few_halvings);
    }
    if (far_) {
        make_zeros(ground, threads);
    }
}

std::optional<terrain::SamplePolynomial> SampleMap::fitted(const terrain::Placement& placement,
                                                           const Ground& ground,
                                                           const Tolerance& tolerance,
                                                           int halvings) const {
    const auto above = placement.sample_from_world(ground.eye);
    if (!above) {
        return std::nullopt;
    }
    const Box& samples = ground.samples;
    const glm::dvec3 middle = placement.world_from_sample(glm::dvec3(
        glm::clamp(glm::dvec2(in_turn(*above)), glm::dvec2(samples.low), glm::dvec2(samples.high)),
        samples.center().z));
    double reach = 0.0;
    for (const double x : {ground.local.low.x, ground.local.high.x}) {
        for (const double y : {ground.local.low.y, ground.local.high.y}) {
            reach = std::max(reach, glm::length(glm::dvec2(x, y) - glm::dvec2(middle)));
        }
    }
    const double heights = placement.exaggeration() * samples.size().z + ground.above;
    for (int i = 0; i <= halvings; ++i) {
        const double fall = reach * reach / radius_of_earth;
        auto made =
            terrain::SamplePolynomial::create(placement, middle, {reach, reach, heights + fall});
        if (made && is_within(*made, tolerance, ground.eye) &&
            keeps_to(*made, map_.rows_between_poles())) {
            return made;
        }
        reach *= 0.5;
    }
    return std::nullopt;
}

// Rays are looked up beside the terrain, too: by a cell on each side.
void SampleMap::make_zeros(const Ground& ground, unsigned threads) {
    step_ = glm::dvec2(ground.samples.size()) / (zero_count - 3.0);
    first_ = glm::dvec2(ground.samples.low) - step_;
    zeros_ = Grid<double>(zero_count, zero_count);
    ParallelOptions parallel;
    parallel.threads = threads;
    parallel_for(
        zero_count,
        [&](int row) {
            for (int col = 0; col < zero_count; ++col) {
                zeros_(col, row) = map_.zero_at(first_ + step_ * glm::dvec2(col, row));
            }
        },
        parallel);
    constexpr int checks = 23; // at other places than the zeros
    for (int i = 0; i < checks * checks; ++i) {
        const glm::dvec2 part = (glm::dvec2(i % checks, i / checks) + 0.5) / double{checks};
        const glm::dvec2 sample = first_ + step_ * (zero_count - 1.0) * part;
        zero_error_ = std::max(zero_error_, std::abs(zero_at(sample) - map_.zero_at(sample)));
    }
}

double SampleMap::zero_at(glm::dvec2 sample) const {
    const glm::dvec2 place = (sample - first_) / step_;
    const geo::Cubic cols = geo::cubic_at(place.x, zero_count);
    const geo::Cubic rows = geo::cubic_at(place.y, zero_count);
    double zero = 0.0;
    for (std::size_t j = 0; j < 4; ++j) {
        double line = 0.0;
        for (std::size_t i = 0; i < 4; ++i) {
            line += cols.weights[i] *
                    zeros_(cols.first + static_cast<int>(i), rows.first + static_cast<int>(j));
        }
        zero += rows.weights[j] * line;
    }
    return zero;
}

glm::dvec3 SampleMap::in_turn(glm::dvec3 sample) const {
    if (around_ > 0.0) {
        sample.x -= around_ * std::round((sample.x - middle_) / around_);
    }
    return sample;
}

std::optional<glm::dvec3> SampleMap::at(glm::dvec3 place, double tolerance) const {
    if (const auto sample = found(near_, place)) {
        return sample;
    }
    if (zero_error_ <= tolerance) {
        if (auto sample = found(far_, place)) {
            sample = in_turn(*sample);
            const glm::dvec2 at = (glm::dvec2(*sample) - first_) / step_;
            if (std::min({at.x, at.y, zero_count - 1.0 - at.x, zero_count - 1.0 - at.y}) >= 0.0) {
                sample->z -= zero_at(glm::dvec2(*sample)) / map_.placement().exaggeration();
                return sample;
            }
        }
    }
    return map_.sample(place);
}

} // namespace reljef::cast
