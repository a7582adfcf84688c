#include "engine/terrain/horizon.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

// A ray from above the ground that is below it later has passed through it in between, and from
// above: there something is seen that is nearer than all behind. A stretch is a sector between two
// radii a < b. A ray of the slope s (height over distance) crosses all of it, and is below the
// lowest height h of it, over the eye, at one end at least: where s b < h with h < 0, or s a < h.

namespace reljef::terrain {
namespace {

constexpr int sector_count = 256;
constexpr double sector_angle = 2.0 * std::numbers::pi / sector_count;
constexpr double radius_growth = 1.0 + 0x1p-4;
constexpr double hides_nothing = -std::numeric_limits<double>::infinity();

glm::dvec2 direction(double azimuth) {
    return {std::cos(azimuth), std::sin(azimuth)};
}

// In samples; of places in the scene frame, metres.
glm::dvec2 sample_of(glm::dvec2 place, glm::dvec2 last, glm::dvec2 spacing) {
    return {0.5 * last.x + place.x / spacing.x, 0.5 * last.y - place.y / spacing.y};
}

double highest_within(const MinMaxPyramid& pyramid, glm::dvec2 sample, glm::dvec2 reach) {
    const Grid<MinMax>& cells = pyramid.level(0);
    const glm::ivec2 last(cells.cols() - 1, cells.rows() - 1);
    const glm::ivec2 low = glm::clamp(glm::ivec2(glm::floor(sample - reach)), glm::ivec2(0), last);
    const glm::ivec2 high = glm::clamp(glm::ivec2(glm::floor(sample + reach)), glm::ivec2(0), last);
    double highest = -std::numeric_limits<double>::infinity();
    for (int row = low.y; row <= high.y; ++row) {
        for (int col = low.x; col <= high.x; ++col) {
            highest = std::max(highest, static_cast<double>(cells(col, row).high));
        }
    }
    return highest;
}

// Of the box as it is seen from the eye: from where on, to where, and how high.
struct SeenBox {
    double nearest = 0.0; // metres, along the ground
    double azimuth = 0.0; // of its middle
    double before = 0.0;  // radians from there to its ends
    double after = 0.0;
    double slope = 0.0; // no point of it is seen higher
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
    seen.slope = top > 0.0 ? top / seen.nearest : top / farthest;
    return seen;
}

} // namespace

std::optional<Horizon> Horizon::create(const Heightfield& heightfield, const MinMaxPyramid& pyramid,
                                       const Placement& placement, const HorizonView& view) {
    if (placement.kind() != PlacementKind::plane) {
        return std::nullopt;
    }
    // Where the placement puts a place in the air over the eye's: next to it.
    const glm::dvec2 last(heightfield.heights.cols() - 1, heightfield.heights.rows() - 1);
    const glm::dvec2 sample = sample_of(glm::dvec2(view.eye), last, heightfield.spacing);
    constexpr double most_cells = 8.0; // looked at one by one
    const glm::dvec2 reach = view.near / heightfield.spacing;
    const bool is_over = sample.x > reach.x && sample.y > reach.y && sample.x < last.x - reach.x &&
                         sample.y < last.y - reach.y;
    if (!is_over || !(std::max(reach.x, reach.y) < most_cells) ||
        !(view.eye.z - view.near >
          placement.exaggeration() * highest_within(pyramid, sample, reach))) {
        return std::nullopt;
    }
    return Horizon(heightfield, pyramid, placement, view);
}

Horizon::Horizon(const Heightfield& heightfield, const MinMaxPyramid& pyramid,
                 const Placement& placement, const HorizonView& view)
    : pyramid_(&pyramid), last_(heightfield.heights.cols() - 1, heightfield.heights.rows() - 1),
      spacing_(heightfield.spacing), exaggeration_(placement.exaggeration()), view_(view),
      sectors_(sector_count) {
    const double farthest = glm::length(last_ * spacing_);
    for (double radius = std::max(std::max(spacing_.x, spacing_.y), view.near);
         radius < radius_growth * farthest; radius *= radius_growth) {
        radii_.push_back(radius);
    }
}

bool Horizon::hides(const Box& box) {
    const SeenBox seen = seen_from(view_.eye, box);
    // Stretches that end before it begins.
    const auto stretches =
        std::upper_bound(radii_.begin(), radii_.end(), seen.nearest) - radii_.begin() - 2;
    const double angle = std::atan(seen.slope) + view_.margin;
    if (stretches < 0 || angle >= 0.5 * std::numbers::pi) {
        return false;
    }
    const double slope = std::tan(angle);
    // One more on each side is for the rounding.
    const int first = static_cast<int>(std::floor((seen.azimuth + seen.before) / sector_angle)) - 1;
    const int last = static_cast<int>(std::floor((seen.azimuth + seen.after) / sector_angle)) + 1;
    for (int index = first; index <= last; ++index) {
        if (!(slope < sector(index)[static_cast<std::size_t>(stretches)])) {
            return false;
        }
    }
    return true;
}

const std::vector<double>& Horizon::sector(int index) {
    const int wrapped = (index % sector_count + sector_count) % sector_count;
    std::vector<double>& made = sectors_[static_cast<std::size_t>(wrapped)];
    if (made.empty()) {
        made = make_sector(wrapped);
    }
    return made;
}

std::vector<double> Horizon::make_sector(int index) const {
    // The tangent to the outer arc in its middle meets the sides there.
    const double outside = 1.0 / std::cos(0.5 * sector_angle);
    const glm::dvec2 right = direction(index * sector_angle);
    const glm::dvec2 left = direction((index + 1) * sector_angle);
    std::vector<double> slopes;
    slopes.reserve(radii_.size());
    double steepest = hides_nothing;
    for (std::size_t i = 0; i + 1 < radii_.size(); ++i) {
        const double inner = radii_[i];
        const double outer = radii_[i + 1];
        const glm::dvec2 eye(view_.eye);
        const std::array corners{inner * right, inner * left, outside * outer * right,
                                 outside * outer * left};
        Stretch stretch{eye + corners[0], eye + corners[0]};
        for (const glm::dvec2 corner : corners) {
            stretch.low = glm::min(stretch.low, eye + corner);
            stretch.high = glm::max(stretch.high, eye + corner);
        }
        if (const auto lowest = lowest_in(stretch)) {
            const double height = *lowest - view_.eye.z;
            steepest = std::max(steepest, height / (height < 0.0 ? outer : inner));
        }
        slopes.push_back(steepest);
    }
    return slopes;
}

// Metres; nothing where it reaches over the border.
std::optional<double> Horizon::lowest_in(const Stretch& stretch) const {
    const glm::dvec2 a = sample_of({stretch.low.x, stretch.high.y}, last_, spacing_);
    const glm::dvec2 b = sample_of({stretch.high.x, stretch.low.y}, last_, spacing_);
    if (a.x < 0.0 || a.y < 0.0 || b.x > last_.x || b.y > last_.y) {
        return std::nullopt;
    }
    glm::ivec2 first(a);
    glm::ivec2 last = glm::min(glm::ivec2(b), glm::ivec2(last_) - 1);
    int level = 0;
    while (last.x - first.x > 1 || last.y - first.y > 1) {
        first /= 2;
        last /= 2;
        ++level;
    }
    const Grid<MinMax>& blocks = pyramid_->level(level);
    float lowest = blocks(first.x, first.y).low;
    for (int row = first.y; row <= last.y; ++row) {
        for (int col = first.x; col <= last.x; ++col) {
            lowest = std::min(lowest, blocks(col, row).low);
        }
    }
    return exaggeration_ * lowest;
}

} // namespace reljef::terrain
