#pragma once

#include <vector>

#include "engine/core/grid.h"

namespace reljef::terrain {

/// Lowest and highest height of a block of cells, metres.
struct MinMax {
    float low = 0.0F;
    float high = 0.0F;
};

/// Bounds of a bilinear height surface over blocks of 2^level × 2^level cells, a cell being the
/// square between four neighbouring samples. Level 0 has (cols−1)×(rows−1) blocks, the last level
/// one. The bounds are exact: a bilinear patch lies between its corners' lowest and highest.
class MinMaxPyramid {
public:
    MinMaxPyramid() = default;
    /// Precondition: at least 2×2 samples.
    explicit MinMaxPyramid(GridView<const float> heights);

    [[nodiscard]] int levels() const { return static_cast<int>(levels_.size()); }
    [[nodiscard]] const Grid<MinMax>& level(int index) const {
        return levels_[static_cast<std::size_t>(index)];
    }
    /// Over the whole surface. Precondition: not default-made.
    [[nodiscard]] MinMax total() const { return levels_.back()(0, 0); }

private:
    std::vector<Grid<MinMax>> levels_;
};

} // namespace reljef::terrain
