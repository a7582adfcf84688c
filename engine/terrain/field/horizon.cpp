#include "engine/terrain/field/horizon.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

// A ray that begins above the ground and is below it later has passed through it. A stretch is the
// part of a sector between two radii a < b, with the lowest ground h above the eye. A ray of the
// slope s (height over distance) crosses all of it and is below h at one end at least: if s b < h
// for h < 0, else if s a < h.

namespace reljef::terrain {
namespace {

constexpr double hides_nothing = -std::numeric_limits<double>::infinity();

glm::dvec2 direction(double azimuth) {
    return {std::cos(azimuth), std::sin(azimuth)};
}

// `place` in the scene frame, metres.
glm::dvec2 sample_of(glm::dvec2 place, glm::dvec2 last, glm::dvec2 spacing) {
    return {0.5 * last.x + place.x / spacing.x, 0.5 * last.y - place.y / spacing.y};
}

GroundRange ground_of(const Heightfield& heightfield, const MinMaxPyramid& pyramid,
                      const Placement& placement) {
    const glm::dvec2 last(heightfield.heights.cols() - 1, heightfield.heights.rows() - 1);
    return [=, &pyramid, spacing = heightfield.spacing, exaggeration = placement.exaggeration()](
               glm::dvec2 low, glm::dvec2 high) -> std::optional<HeightRange> {
        const glm::dvec2 first = sample_of({low.x, high.y}, last, spacing);
        const glm::dvec2 end = sample_of({high.x, low.y}, last, spacing);
        if (!(first.x >= 0.0 && first.y >= 0.0 && end.x <= last.x && end.y <= last.y)) {
            return std::nullopt;
        }
        const glm::ivec2 last_cell(last - 1.0);
        const MinMax range = pyramid.bounds(glm::min(glm::ivec2(first), last_cell),
                                            glm::min(glm::ivec2(end), last_cell));
        return HeightRange{exaggeration * range.low, exaggeration * range.high};
    };
}

struct SeenBox {
    double nearest = 0.0; // horizontal distance, metres
    double azimuth = 0.0; // of the middle
    double before = 0.0;  // radians from the middle to the ends
    double after = 0.0;
    double slope = 0.0; // of the highest ray to the box
};

SeenBox seen_from(glm::dvec3 eye, const Box& box) {
    const glm::dvec2 from(eye);
    const glm::dvec2 low(box.low);
    const glm::dvec2 high(box.high);
    const glm::dvec2 center = 0.5 * (low + high) - from;
    SeenBox seen;
    seen.nearest = glm::distance(from, glm::clamp(from, low, high));
    seen.azimuth = std::atan2(center.y, center.x);
    double farthest = 0.0;
    for (int i = 0; i < 4; ++i) {
        const glm::dvec2 corner =
            glm::dvec2(i % 2 == 0 ? low.x : high.x, i < 2 ? low.y : high.y) - from;
        const double turn =
            std::remainder(std::atan2(corner.y, corner.x) - seen.azimuth, 2.0 * std::numbers::pi);
        seen.before = std::min(seen.before, turn);
        seen.after = std::max(seen.after, turn);
        farthest = std::max(farthest, glm::length(corner));
    }
    const double top = box.high.z - eye.z;
    const double distance = top > 0.0 ? seen.nearest : farthest;
    seen.slope = distance > 0.0 ? top / distance : std::numeric_limits<double>::infinity();
    return seen;
}

} // namespace

std::optional<Horizon> Horizon::create(const Heightfield& heightfield, const MinMaxPyramid& pyramid,
                                       const Placement& placement, const HorizonView& view) {
    if (placement.kind() != PlacementKind::plane) {
        return std::nullopt;
    }
    GroundRange ground = ground_of(heightfield, pyramid, placement);
    const glm::dvec2 eye(view.eye);
    const auto below = ground(eye - view.near, eye + view.near);
    if (!below || !(view.eye.z - view.near > below->high)) {
        return std::nullopt;
    }
    const glm::dvec2 last(heightfield.heights.cols() - 1, heightfield.heights.rows() - 1);
    const glm::dvec2 spacing = heightfield.spacing;
    return Horizon(std::move(ground), {std::max(spacing.x, spacing.y), glm::length(last * spacing)},
                   view);
}

Horizon::Horizon(GroundRange ground, const HorizonOptions& reach, const HorizonView& view)
    : ground_(std::move(ground)), view_(view),
      sector_angle_(2.0 * std::numbers::pi / reach.sectors),
      sectors_(static_cast<std::size_t>(reach.sectors)) {
    // The maximum is at 45 degrees.
    rectangle_growth_ =
        std::sqrt(2.0) * std::cos(0.25 * std::numbers::pi - 0.5 * sector_angle_) + 0x1p-10;
    for (double radius = std::max(reach.first, view.near); radius < reach.growth * reach.last;
         radius *= reach.growth) {
        radii_.push_back(radius);
    }
}

bool Horizon::hides(const Box& box) {
    const SeenBox seen = seen_from(view_.eye, box);
    // The last stretch that ends before the box begins.
    const double end = seen.nearest / rectangle_growth_;
    const auto stretch = std::upper_bound(radii_.begin(), radii_.end(), end) - radii_.begin() - 2;
    const double angle = std::atan(seen.slope) + view_.margin;
    if (stretch < 0 || angle >= 0.5 * std::numbers::pi) {
        return false;
    }
    const double slope = std::tan(angle);
    const auto count = static_cast<int>(sectors_.size());
    // One more sector on each side, for rounding.
    const int first =
        static_cast<int>(std::floor((seen.azimuth + seen.before) / sector_angle_)) - 1;
    const int last = static_cast<int>(std::floor((seen.azimuth + seen.after) / sector_angle_)) + 1;
    for (int index = first; index <= last; ++index) {
        const int sector = (index % count + count) % count;
        if (!(slope < steepest_before(sector, static_cast<std::size_t>(stretch)))) {
            return false;
        }
    }
    return true;
}

// The steepest hidden slope behind the stretches 0 to `stretch`.
double Horizon::steepest_before(int sector, std::size_t stretch) {
    std::vector<double>& slopes = sectors_[static_cast<std::size_t>(sector)];
    while (slopes.size() <= stretch) {
        const double before = slopes.empty() ? hides_nothing : slopes.back();
        slopes.push_back(std::max(before, slope_of(sector, slopes.size()).value_or(hides_nothing)));
    }
    return slopes[stretch];
}

// Empty if the ground does not cover the stretch.
std::optional<double> Horizon::slope_of(int sector, std::size_t stretch) const {
    // Where the tangent in the middle of the outer arc meets the sides.
    const double outside = 1.0 / std::cos(0.5 * sector_angle_);
    const glm::dvec2 right = direction(sector * sector_angle_);
    const glm::dvec2 left = direction((sector + 1) * sector_angle_);
    const double inner = radii_[stretch];
    const double outer = radii_[stretch + 1];
    const std::array corners{inner * right, inner * left, outside * outer * right,
                             outside * outer * left};
    glm::dvec2 low = corners[0];
    glm::dvec2 high = corners[0];
    for (const glm::dvec2 corner : corners) {
        low = glm::min(low, corner);
        high = glm::max(high, corner);
    }
    const glm::dvec2 eye(view_.eye);
    const auto ground = ground_(eye + low, eye + high);
    if (!ground) {
        return std::nullopt;
    }
    const double height = ground->low - view_.eye.z;
    return height / (height < 0.0 ? outer : inner);
}

} // namespace reljef::terrain
