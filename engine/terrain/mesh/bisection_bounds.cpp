#include "engine/terrain/mesh/bisection.h"

namespace reljef::terrain {
namespace {

std::size_t area(glm::ivec2 size) {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
}

} // namespace

glm::ivec2 Bisection::splits_in_middles(glm::ivec2 samples, std::size_t level) {
    const glm::ivec2 last = samples - 1;
    return level == 0 ? last : last / (1 << level) + 1;
}

glm::ivec2 Bisection::splits_on_sides(glm::ivec2 samples, std::size_t level) {
    const glm::ivec2 last = samples - 1;
    return {last.x / (1 << level) + 1, 2 * last.y / (1 << level) + 1};
}

std::size_t Bisection::bounds_count(glm::ivec2 samples) {
    std::size_t splits = 0;
    for (std::size_t level = 1; level < levels; ++level) {
        splits += area(splits_in_middles(samples, level)) + area(splits_on_sides(samples, level));
    }
    return 2 * splits;
}

template <class Self, class Visit> void Bisection::for_each_stored(Self& self, const Visit& visit) {
    for (std::size_t level = 1; level < levels; ++level) {
        const int half = 1 << (level - 1);
        auto& middles = self.in_middles_[level];
        for (int row = 0; row < middles.rows(); ++row) {
            for (int col = 0; col < middles.cols(); ++col) {
                visit(middles(col, row), half * glm::ivec2(2 * col + 1, 2 * row + 1));
            }
        }
        auto& sides = self.on_sides_[level];
        for (int row = 0; row < sides.rows(); ++row) {
            const int first = 1 - row % 2;
            for (int col = 0; col < sides.cols(); ++col) {
                visit(sides(col, row), half * glm::ivec2(2 * col + first, row));
            }
        }
    }
}

std::vector<float> Bisection::bounds() const {
    std::vector<float> bounds;
    bounds.reserve(bounds_count({heights_.cols(), heights_.rows()}));
    for_each_stored(*this, [&](const StoredSplit& split, glm::ivec2) {
        bounds.push_back(split.error);
        bounds.push_back(split.radius);
    });
    return bounds;
}

Bisection::Bisection(const Heightfield& heightfield, const Placement& placement,
                     std::span<const float> bounds, const ParallelOptions& parallel)
    : Bisection(heightfield, placement, parallel, CellsOnly{}) {
    check(bounds.size() == bounds_count({heights_.cols(), heights_.rows()}),
          "the bounds of another bisection");
    auto next = bounds.begin();
    for_each_stored(*this, [&](StoredSplit& split, glm::ivec2 sample) {
        split.error = *next++;
        split.radius = *next++;
        if (sample.x < heights_.cols() && sample.y < heights_.rows()) {
            split.height = heights_(sample.x, sample.y);
        }
    });
}

} // namespace reljef::terrain
