#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/grid.h"

namespace reljef::terrain {

/// Lowest and highest height of a block of cells, metres.
struct MinMax {
    float low = 0.0F;
    float high = 0.0F;
};

/// Bounds of a bilinear height surface over blocks of 2^level × 2^level cells. A cell lies between
/// four samples. The last level has one block. Level 0, the cells, is not stored: its four samples
/// are there. The bounds are exact: a bilinear patch has its extrema at its corners.
class MinMaxPyramid {
public:
    MinMaxPyramid() = default;
    /// Precondition: at least 2×2 samples.
    explicit MinMaxPyramid(GridView<const float> heights);

    [[nodiscard]] int last_level() const { return static_cast<int>(levels_.size()); }
    /// Precondition: 1 to last_level().
    [[nodiscard]] const Grid<MinMax>& level(int index) const {
        return levels_[static_cast<std::size_t>(index) - 1];
    }
    /// Of the whole surface. Precondition: not default-constructed.
    [[nodiscard]] MinMax total() const { return levels_.back()(0, 0); }
    /// Of the at most four blocks that contain the cells `first` to `last`.
    /// Precondition: cells of the surface.
    [[nodiscard]] MinMax bounds(glm::ivec2 first, glm::ivec2 last) const;

private:
    std::vector<Grid<MinMax>> levels_; // from level 1
};

} // namespace reljef::terrain
