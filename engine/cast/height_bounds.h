#pragma once

#include <limits>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/geometry.h"
#include "engine/core/grid.h"

namespace reljef::cast {

/// Bounds of a terrain's heights over squares of its samples: rays above them need no search.
class HeightBounds {
public:
    /// Nothing is known: everything may be ground.
    HeightBounds() = default;

    /// `samples`: columns and rows that rays may pass. `ground`: boxes around all ground there, in
    /// samples and metres of height. `columns_around`: those after which a globe begins anew; 0: it
    /// is none.
    HeightBounds(const Box& samples, std::span<const Box> ground, double columns_around);

    /// Of the ground in the squares that a box meets; beyond the samples, in the outermost ones.
    /// Where there is none, the interval's end is before its begin.
    [[nodiscard]] Interval within(const Box& box) const;

private:
    struct Squares {
        glm::ivec2 first{0};
        glm::ivec2 last{0};
    };
    [[nodiscard]] Squares squares_of(const Box& box) const;
    void add(const Box& ground);

    glm::dvec2 first_{0.0}; // sample of the first square
    glm::dvec2 last_{0.0};
    glm::dvec2 step_{1.0};
    std::vector<Grid<Interval>> levels_; // each half as fine as the one before
};

} // namespace reljef::cast
