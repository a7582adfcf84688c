#include "engine/cast/height_bounds.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

#include <glm/common.hpp>

namespace reljef::cast {
namespace {

constexpr int squares_a_side = 64;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Interval nothing{infinity, -infinity};

Interval merged(Interval a, Interval b) {
    return {std::min(a.begin, b.begin), std::max(a.end, b.end)};
}

Grid<Interval> halved(const Grid<Interval>& fine) {
    Grid<Interval> coarse(fine.cols() / 2, fine.rows() / 2, nothing);
    for (int row = 0; row < fine.rows(); ++row) {
        for (int col = 0; col < fine.cols(); ++col) {
            Interval& square = coarse(col / 2, row / 2);
            square = merged(square, fine(col, row));
        }
    }
    return coarse;
}

} // namespace

HeightBounds::HeightBounds(const Box& samples, std::span<const Box> ground, double columns_around)
    : first_(samples.low), last_(samples.high),
      step_(glm::max((last_ - first_) / double{squares_a_side}, glm::dvec2(1e-9))) {
    levels_.emplace_back(squares_a_side, squares_a_side, nothing);
    for (const Box& part : ground) {
        if (!(columns_around > 0.0)) {
            add(part);
            continue;
        }
        const double last = std::floor((last_.x - part.low.x) / columns_around);
        for (double turn = std::ceil((first_.x - part.high.x) / columns_around); turn <= last;
             ++turn) {
            const glm::dvec3 by(turn * columns_around, 0.0, 0.0);
            add({part.low + by, part.high + by});
        }
    }
    while (levels_.back().cols() > 1) {
        levels_.push_back(halved(levels_.back()));
    }
}

// Beyond the samples: the outermost ones.
HeightBounds::Squares HeightBounds::squares_of(const Box& box) const {
    const glm::dvec2 end(squares_a_side - 1);
    const auto square = [&](glm::dvec3 place) {
        return glm::ivec2(
            glm::clamp(glm::floor((glm::dvec2(place) - first_) / step_), glm::dvec2(0.0), end));
    };
    return {square(box.low), square(box.high)};
}

void HeightBounds::add(const Box& ground) {
    const Squares squares = squares_of(ground);
    for (int row = squares.first.y; row <= squares.last.y; ++row) {
        for (int col = squares.first.x; col <= squares.last.x; ++col) {
            Interval& square = levels_.front()(col, row);
            square = merged(square, {ground.low.z, ground.high.z});
        }
    }
}

Interval HeightBounds::within(const Box& box) const {
    if (levels_.empty()) {
        return {-infinity, infinity};
    }
    const Squares squares = squares_of(box);
    const glm::ivec2 extent = squares.last - squares.first;
    const auto level =
        static_cast<int>(std::bit_width(static_cast<unsigned>(std::max(extent.x, extent.y))));
    Interval found = nothing;
    for (int row = squares.first.y >> level; row <= squares.last.y >> level; ++row) {
        for (int col = squares.first.x >> level; col <= squares.last.x >> level; ++col) {
            found = merged(found, levels_[static_cast<std::size_t>(level)](col, row));
        }
    }
    return found;
}

} // namespace reljef::cast
