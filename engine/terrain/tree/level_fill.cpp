#include "engine/terrain/tree/level_fill.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <glm/common.hpp>

#include "engine/terrain/tree/level_step.h"
#include "engine/terrain/tree/tile_error.h"

namespace reljef::terrain {
namespace {

/// A vertex between two vertices of the next coarser level, along an axis.
struct Between {
    int first = 0;      ///< coarser vertex
    double share = 0.0; ///< of the next one
};

class FinerVertices {
public:
    FinerVertices(const TileTree& tree, int level)
        : tree_(tree), level_(level), last_(level_cells(tree, level)),
          coarser_cells_(level_cells(tree, level + 1)),
          end_(glm::ivec2(tree.cols(), tree.rows()) - 1) {}

    /// Of an axis. Beyond the raster its border repeats, except beyond the seam of a globe.
    [[nodiscard]] Between place(int vertex, int axis) const {
        const bool repeats = axis == 1 || !tree_.wraps_longitude();
        const int inside = std::clamp(vertex, 0, last_[axis]);
        if (inside != vertex && !repeats) {
            const int cell = (vertex - (vertex & 1)) / 2;
            return {cell, 0.5 * (vertex & 1)};
        }
        const int cell = std::min(inside / 2, coarser_cells_[axis] - 1);
        const double begin = on_axis(2 * cell, axis);
        const double width = on_axis(2 * cell + 2, axis) - begin;
        return {cell, (on_axis(inside, axis) - begin) / width};
    }

private:
    [[nodiscard]] double on_axis(int vertex, int axis) const {
        glm::ivec2 sample(0);
        sample[axis] = std::min(vertex << level_, end_[axis]);
        return tree_.place(sample)[axis];
    }

    const TileTree& tree_;
    int level_;
    glm::ivec2 last_; // vertex
    glm::ivec2 coarser_cells_;
    glm::ivec2 end_; // sample
};

/// Absent: a vertex with a share is missing.
std::optional<float> height_between(const LevelVertices& coarser, const Between& x,
                                    const Between& y) {
    double sum = 0.0;
    for (const glm::ivec2 corner : {glm::ivec2(0, 0), {1, 0}, {0, 1}, {1, 1}}) {
        const double share =
            (corner.x == 1 ? x.share : 1.0 - x.share) * (corner.y == 1 ? y.share : 1.0 - y.share);
        const glm::ivec2 at = glm::ivec2(x.first, y.first) + corner - coarser.first;
        const bool is_there = at.x >= 0 && at.y >= 0 && at.x < coarser.heights.cols() &&
                              at.y < coarser.heights.rows();
        if (share > 0.0 && !is_there) {
            return std::nullopt;
        }
        sum += share > 0.0 ? share * coarser.heights(at.x, at.y) : 0.0;
    }
    return static_cast<float>(sum);
}

} // namespace

bool has_voids(const Grid<float>& heights) {
    const auto samples = heights.samples();
    return std::any_of(samples.begin(), samples.end(), [](float h) { return std::isnan(h); });
}

LevelVertices filled_from(const TileTree& tree, LevelVertices finer, const LevelVertices& coarser) {
    const FinerVertices vertices(tree, finer.level);
    for (int row = 0; row < finer.heights.rows(); ++row) {
        for (int col = 0; col < finer.heights.cols(); ++col) {
            float& height = finer.heights(col, row);
            if (std::isnan(height)) {
                height = height_between(coarser, vertices.place(finer.first.x + col, 0),
                                        vertices.place(finer.first.y + row, 1))
                             .value_or(height);
            }
        }
    }
    return finer;
}

Grid<float> filled_samples(const TileTree& tree, TreeTile tile, Grid<float> samples,
                           Grid<float> heights) {
    const int border = sample_border(tile.level);
    const auto first = [&](int level) {
        return TileTree::first(tile) / (1 << level) - (border >> level);
    };
    std::vector<LevelVertices> levels{{0, first(0), std::move(samples)}};
    for (int level = 1; level < tile.level; ++level) {
        levels.push_back({level, first(level),
                          coarser_heights(levels.back().heights, {tree, level, first(level)})});
    }
    LevelVertices filled{tile.level, first(tile.level), std::move(heights)};
    for (int level = tile.level - 1; level >= 0; --level) {
        filled = filled_from(tree, std::move(levels[static_cast<std::size_t>(level)]), filled);
    }
    return std::move(filled.heights);
}

} // namespace reljef::terrain
