#include "engine/cast/ray_fan.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "engine/terrain/field/sample_polynomial.h"

namespace reljef::cast {
namespace {

// In a block, from its middle, in halves of its sides: corners, middle, and the middles of two
// sides. Behind them what rays of second degree need, too: the other sides, and places at which a
// third degree shows.
constexpr std::array<glm::dvec2, max_fan_places> places{
    glm::dvec2(-1.0, -1.0), glm::dvec2(1.0, -1.0),  glm::dvec2(-1.0, 1.0), glm::dvec2(1.0, 1.0),
    glm::dvec2(0.0, 0.0),   glm::dvec2(1.0, 0.0),   glm::dvec2(0.0, 1.0),  glm::dvec2(-1.0, 0.0),
    glm::dvec2(0.0, -1.0),  glm::dvec2(-0.5, -0.5), glm::dvec2(0.5, -0.5), glm::dvec2(-0.5, 0.5),
    glm::dvec2(0.5, 0.5)};

constexpr std::size_t linear_places = 7;

// The places at which rays are known.
std::span<const glm::dvec2> places_of(FanDegree degree) {
    const std::span<const glm::dvec2> all = places;
    switch (degree) {
    case FanDegree::constant:
        return all.subspan(4, 1); // the middle
    case FanDegree::linear:
        return all.first(linear_places);
    case FanDegree::second:
        break;
    }
    return all;
}

glm::dvec2 pixel_at(const PixelBlock& block, glm::dvec2 place) {
    return glm::dvec2(block.first) + (0.5 + 0.5 * place) * glm::dvec2(block.size);
}

bool is_finite(glm::dvec3 sample) {
    return !glm::any(glm::isnan(sample)) && !glm::any(glm::isinf(sample));
}

using Samples = std::array<glm::dvec3, max_fan_places>;

// Between the plane through the corners and the middle.
PictureRays::Vectors linear_through(const Samples& at, const PixelBlock& block) {
    PictureRays::Vectors found;
    found.right = (at[1] - at[0] + at[3] - at[2]) / (2.0 * block.size.x);
    found.down = (at[2] - at[0] + at[3] - at[1]) / (2.0 * block.size.y);
    const glm::dvec3 middle = 0.5 * (0.25 * (at[0] + at[1] + at[2] + at[3]) + at[4]);
    const glm::dvec2 pixel = pixel_at(block, glm::dvec2(0.0));
    found.first = middle - pixel.x * found.right - pixel.y * found.down;
    return found;
}

// By central differences; each is the mean of those of three lines, of which the middle one counts
// twice.
PictureRays::Vectors bent_through(const Samples& at, const PixelBlock& block) {
    const auto mean = [](glm::dvec3 first, glm::dvec3 middle, glm::dvec3 last) {
        return 0.25 * (first + 2.0 * middle + last);
    };
    const glm::dvec3 west = mean(at[0], at[7], at[2]);
    const glm::dvec3 east = mean(at[1], at[5], at[3]);
    const glm::dvec3 north = mean(at[0], at[8], at[1]);
    const glm::dvec3 south = mean(at[2], at[6], at[3]);
    const glm::dvec2 half = 0.5 * glm::dvec2(block.size);
    const glm::dvec3 right = 0.5 * (east - west) / half.x;
    const glm::dvec3 down = 0.5 * (south - north) / half.y;
    PictureRays::Vectors found;
    found.bends = {0.5 * (west + east - 2.0 * mean(at[8], at[4], at[6])) / (half.x * half.x),
                   0.25 * (at[0] - at[1] - at[2] + at[3]) / (half.x * half.y),
                   0.5 * (north + south - 2.0 * mean(at[7], at[4], at[5])) / (half.y * half.y)};
    // From the middle of the block to the corner of the picture.
    const glm::dvec2 pixel = pixel_at(block, glm::dvec2(0.0));
    found.right = right - 2.0 * pixel.x * found.bends[0] - pixel.y * found.bends[1];
    found.down = down - pixel.x * found.bends[1] - 2.0 * pixel.y * found.bends[2];
    found.first = at[4] - (found.at(pixel) - found.first);
    return found;
}

PictureRays::Vectors vectors_through(const Samples& at, const PixelBlock& block, FanDegree degree) {
    switch (degree) {
    case FanDegree::constant:
        return {.first = at[0]};
    case FanDegree::linear:
        return linear_through(at, block);
    case FanDegree::second:
        break;
    }
    return bent_through(at, block);
}

// Finds what follows from the samples.
void fit(const PixelBlock& block, FanDegree degree, RayFan& fan) {
    fan.vectors = vectors_through(fan.samples, block, degree);
    const auto known = places_of(degree);
    for (std::size_t i = 0; i < fan.count; ++i) {
        const glm::dvec3 found = fan.vectors.at(pixel_at(block, known[i]));
        fan.misfit = glm::max(fan.misfit, glm::abs(found - fan.samples[i]));
        fan.box.add(fan.samples[i]);
    }
    const glm::dvec3 beyond = fan.misfit + fan.vectors.bulge(glm::dvec2(block.size));
    fan.box = {fan.box.low - beyond, fan.box.high + beyond};
}

} // namespace

std::optional<RayFan> ray_fan(const PixelBlock& block, FanDegree degree, double t,
                              const SampleOfRay& sample_of) {
    RayFan fan;
    fan.t = t;
    const auto known = places_of(degree);
    fan.count = known.size();
    for (std::size_t i = 0; i < fan.count; ++i) {
        const auto sample = sample_of(pixel_at(block, known[i]), t);
        if (!sample || !is_finite(*sample)) {
            return std::nullopt;
        }
        fan.samples[i] = *sample;
    }
    fit(block, degree, fan);
    return fan;
}

// In (-1, 1).
const std::array<double, FanTrack::nodes>& FanTrack::chebyshev_nodes() {
    static const std::array<double, nodes> made = [] {
        std::array<double, nodes> places_of_nodes{};
        for (std::size_t i = 0; i < nodes; ++i) {
            const double part = (static_cast<double>(i) + 0.5) / static_cast<double>(nodes);
            places_of_nodes[i] = -std::cos(std::numbers::pi * part);
        }
        return places_of_nodes;
    }();
    return made;
}

std::optional<FanTrack> FanTrack::create(const PixelBlock& block, FanDegree degree, Interval depths,
                                         const SampleOfRay& sample_of, const IsUnseen& is_unseen) {
    FanTrack track(block, degree, depths);
    const auto known = places_of(degree);
    for (std::size_t i = 0; i < known.size(); ++i) {
        Powers samples{};
        for (std::size_t node = 0; node < nodes; ++node) {
            const auto sample =
                sample_of(pixel_at(block, known[i]), track.depth_of(chebyshev_nodes()[node]));
            if (!sample || !is_finite(*sample)) {
                return std::nullopt;
            }
            samples[node] = *sample;
        }
        track.powers_[i] = terrain::powers_through(chebyshev_nodes(), samples);
        const bool is_checked = i == 0 || i == 3; // at opposite corners
        if (is_checked && !track.is_precise(i, sample_of, is_unseen)) {
            return std::nullopt;
        }
    }
    return track;
}

bool FanTrack::is_precise(std::size_t place, const SampleOfRay& sample_of,
                          const IsUnseen& is_unseen) const {
    constexpr std::array between_nodes{-1.0, -0.3, 0.6, 1.0};
    return std::all_of(between_nodes.begin(), between_nodes.end(), [&](double part) {
        const double t = depth_of(part);
        const auto sample = sample_of(pixel_at(block_, places_of(degree_)[place]), t);
        return sample && is_unseen(at(place, t), *sample, t);
    });
}

double FanTrack::depth_of(double part) const {
    return 0.5 * (depths_.begin + depths_.end) + 0.5 * part * (depths_.end - depths_.begin);
}

glm::dvec3 FanTrack::at(std::size_t place, double t) const {
    const double part = (2.0 * t - depths_.begin - depths_.end) / (depths_.end - depths_.begin);
    const Powers& terms = powers_[place];
    glm::dvec3 value = terms.back();
    for (std::size_t i = terms.size() - 1; i-- > 0;) {
        value = value * part + terms[i];
    }
    return value;
}

RayFan FanTrack::fan(double t) const {
    RayFan fan;
    fan.t = t;
    fan.count = places_of(degree_).size();
    for (std::size_t i = 0; i < fan.count; ++i) {
        fan.samples[i] = at(i, t);
    }
    fit(block_, degree_, fan);
    return fan;
}

} // namespace reljef::cast
