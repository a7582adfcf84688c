#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/grid.h"
#include "engine/terrain/field/min_max_pyramid.h"

namespace reljef::cast {

/// A heightfield to cast rays at: its samples, which it borrows, and the highest heights of blocks
/// of 2^level × 2^level cells. At most 8 bytes per sample, and up to 63 columns and rows more.
class RayTile {
public:
    /// `heights`: metres, finite; they must outlive the tile. Fewer than 2×2 have no surface.
    explicit RayTile(GridView<const float> heights);

    [[nodiscard]] GridView<const float> heights() const { return heights_; }
    /// Along each axis; 0 without a surface.
    [[nodiscard]] glm::ivec2 cells() const { return cells_; }
    [[nodiscard]] terrain::MinMax total() const { return total_; }

    /// The blocks of the top level are the largest.
    [[nodiscard]] int top_level() const { return top_level_; }
    /// Element of a block in maxima(): (block.y + 2·rows − (2·rows >> level)) · stride + block.x.
    [[nodiscard]] const float* maxima() const { return maxima_.data(); }
    [[nodiscard]] int rows() const { return rows_; }
    [[nodiscard]] int stride() const { return stride_; }
    [[nodiscard]] float max_of(int level, glm::ivec2 block) const {
        return maxima_[index_of(level, block)];
    }
    /// Bound of the heights over the cells `first` to `last`. Precondition: cells of the tile.
    [[nodiscard]] float max_within(glm::ivec2 first, glm::ivec2 last) const;

    /// Of its own, not the samples.
    [[nodiscard]] std::size_t bytes() const { return maxima_.size() * sizeof(float); }

private:
    [[nodiscard]] std::size_t index_of(int level, glm::ivec2 block) const {
        return static_cast<std::size_t>(block.y + 2 * rows_ - ((2 * rows_) >> level)) *
                   static_cast<std::size_t>(stride_) +
               static_cast<std::size_t>(block.x);
    }
    void fill_cells();
    void fill_level(int level);

    GridView<const float> heights_;
    glm::ivec2 cells_{0};
    terrain::MinMax total_;
    int top_level_ = 0;
    int rows_ = 0; // of level 0: a multiple of 2^top_level, so that each level begins at a row
    int stride_ = 0;
    std::vector<float> maxima_;
};

} // namespace reljef::cast
