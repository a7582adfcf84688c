#include "engine/terrain/tree/level_step.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include <glm/common.hpp>

#include "engine/terrain/tree/tile_error.h"

namespace reljef::terrain {
namespace {

/// A row of vertices, apart by their place: loops over contiguous floats become vector code.
struct SplitRow {
    std::vector<float> on;      ///< at the coarser vertices
    std::vector<float> between; ///< around them: one more

    explicit SplitRow(std::size_t coarse) : on(coarse), between(coarse + 1) {}
};

void split(std::span<const float> row, SplitRow& into) {
    const std::size_t count = into.on.size();
    const float* const from = row.data();
    const LoopOutput between = into.between.data();
    const LoopOutput on = into.on.data();
    for (std::size_t i = 0; i < count; ++i) {
        between[i] = from[2 * i];
        on[i] = from[2 * i + 1];
    }
    between[count] = from[2 * count];
}

float mean_without_voids(const std::array<const SplitRow*, 3>& rows, std::size_t i) {
    float sum = 0.0F;
    float weights = 0.0F;
    const auto add = [&](float height, float weight) {
        sum += std::isnan(height) ? 0.0F : weight * height;
        weights += std::isnan(height) ? 0.0F : weight;
    };
    for (std::size_t j = 0; j < rows.size(); ++j) {
        const float weight = j == 1 ? 2.0F : 1.0F;
        add(rows.at(j)->between[i], weight);
        add(rows.at(j)->on[i], 2.0F * weight);
        add(rows.at(j)->between[i + 1], weight);
    }
    return weights > 0.0F ? sum / weights : std::numeric_limits<float>::quiet_NaN();
}

void add_weighted(const std::vector<float>& above, const std::vector<float>& on,
                  const std::vector<float>& below, std::vector<float>& sums) {
    const float* const a = above.data();
    const float* const b = on.data();
    const float* const c = below.data();
    const LoopOutput sum = sums.data();
    for (std::size_t i = 0; i < sums.size(); ++i) {
        sum[i] = a[i] + c[i] + 2.0F * b[i];
    }
}

/// A row of the coarser level from the rows above, on and below it.
void coarsen(const std::array<const SplitRow*, 3>& rows, SplitRow& sums, std::span<float> coarse) {
    const auto [above, on, below] = rows;
    add_weighted(above->on, on->on, below->on, sums.on);
    add_weighted(above->between, on->between, below->between, sums.between);
    const float* const sum_on = sums.on.data();
    const float* const sum_between = sums.between.data();
    const LoopOutput means = coarse.data();
    int voids = 0;
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        const float mean = (sum_between[i] + sum_between[i + 1] + 2.0F * sum_on[i]) * 0.0625F;
        means[i] = mean;
        voids |= mean != mean ? 1 : 0;
    }
    for (std::size_t i = 0; voids != 0 && i < coarse.size(); ++i) {
        coarse[i] = std::isnan(coarse[i]) ? mean_without_voids(rows, i) : coarse[i];
    }
}

/// The vertices that have all finer ones around them.
Grid<float> means_around(const Grid<float>& finer) {
    Grid<float> heights((finer.cols() - 1) / 2, (finer.rows() - 1) / 2);
    SplitRow sums(static_cast<std::size_t>(heights.cols()));
    std::vector<SplitRow> rows(3, sums);
    const auto at = [&](int row) { return &rows[static_cast<std::size_t>(row % 3)]; };
    split(finer.row(0), *at(0));
    for (int row = 0; row < heights.rows(); ++row) {
        split(finer.row(2 * row + 1), *at(2 * row + 1));
        split(finer.row(2 * row + 2), *at(2 * row + 2));
        coarsen({at(2 * row), at(2 * row + 1), at(2 * row + 2)}, sums, heights.row(row));
    }
    return heights;
}

void repeat_border_cols(Grid<float>& heights, int first, int last) {
    const int begin = std::max(0, -first);
    const int count = std::min(first + heights.cols() - 1, last) - first + 1;
    if (begin == 0 && count == heights.cols()) {
        return;
    }
    for (int row = 0; row < heights.rows(); ++row) {
        const auto cells = heights.row(row);
        std::fill(cells.begin(), cells.begin() + begin, cells[static_cast<std::size_t>(begin)]);
        std::fill(cells.begin() + count, cells.end(), cells[static_cast<std::size_t>(count - 1)]);
    }
}

void repeat_border_rows(Grid<float>& heights, int first, int last) {
    for (int row = 0; row < heights.rows(); ++row) {
        const int inside = std::clamp(first + row, 0, last) - first;
        if (inside != row) {
            std::copy(heights.row(inside).begin(), heights.row(inside).end(),
                      heights.row(row).begin());
        }
    }
}

/// A level of a globe over the next finer one, near its seam and its poles.
class ClosedStep {
public:
    ClosedStep(const Grid<float>& finer, const PlacedVertices& coarser)
        : finer_(finer), first_(coarser.first), wrap_(coarser.tree.wrap()),
          last_(level_cells(coarser.tree, coarser.level)),
          finer_last_(level_cells(coarser.tree, coarser.level - 1)) {}

    void close(Grid<float>& heights) const {
        set_poles(finer_, heights);
        if (!wrap_.around) {
            return;
        }
        if (2 * last_.x != finer_last_.x) {
            move_beyond_seam(heights);
        }
        if (first_.x <= 0 && first_.x + heights.cols() > last_.x) {
            turn_around(heights);
        }
    }

private:
    /// Rows from above and below a pole would give it many heights.
    void set_poles(const Grid<float>& finer, Grid<float>& heights) const {
        if (wrap_.begins_at_pole) {
            set_pole(finer, 0, 0, heights);
        }
        if (wrap_.ends_at_pole) {
            set_pole(finer, last_.y, finer_last_.y, heights);
        }
    }
    void set_pole(const Grid<float>& finer, int vertex, int finer_vertex,
                  Grid<float>& heights) const {
        const int row = vertex - first_.y;
        if (row < 0 || row >= heights.rows()) {
            return;
        }
        Grid<float> pole(finer.cols(), 3);
        const auto from = finer.row(finer_vertex - (2 * first_.y - 1));
        for (int i = 0; i < pole.rows(); ++i) {
            std::copy(from.begin(), from.end(), pole.row(i).begin());
        }
        const Grid<float> mean = means_around(pole);
        for (int col = 0; col < heights.cols(); ++col) {
            heights(col, row) = std::isnan(mean(col, 0)) ? height_of_void_pole : mean(col, 0);
        }
    }

    /// With an odd number of finer cells around, the last cell of this level has only one of them.
    /// So the vertices of this level lie at odd finer vertices as seen from beyond the seam.
    void move_beyond_seam(Grid<float>& heights) const {
        const int west = std::clamp(-first_.x, 0, heights.cols());
        const int east = std::clamp(last_.x - first_.x, 0, heights.cols());
        copy_means(0, west, 1, heights);
        copy_means(east, heights.cols(), -1, heights);
    }
    /// Of finer vertices `shift` beside those around the columns from `begin` to `end`.
    void copy_means(int begin, int end, int shift, Grid<float>& heights) const {
        if (begin >= end) {
            return;
        }
        Grid<float> around(2 * (end - begin) + 1, finer_.rows());
        for (int row = 0; row < around.rows(); ++row) {
            std::copy_n(finer_.row(row).begin() + 2 * begin + shift, around.cols(),
                        around.row(row).begin());
        }
        Grid<float> means = means_around(around);
        set_poles(around, means);
        for (int row = 0; row < heights.rows(); ++row) {
            std::copy(means.row(row).begin(), means.row(row).end(),
                      heights.row(row).begin() + begin);
        }
    }

    /// The grid has all columns: what lies beyond them may be more than a turn away.
    void turn_around(Grid<float>& heights) const {
        for (int col = 0; col < heights.cols(); ++col) {
            const int vertex = first_.x + col;
            const int turned = ((vertex % last_.x) + last_.x) % last_.x;
            for (int row = 0; (vertex < 0 || vertex > last_.x) && row < heights.rows(); ++row) {
                heights(col, row) = heights(turned - first_.x, row);
            }
        }
    }

    const Grid<float>& finer_;
    glm::ivec2 first_; // of this level
    geo::GlobalWrap wrap_;
    glm::ivec2 last_; // vertices of this level
    glm::ivec2 finer_last_;
};

} // namespace

Grid<float> coarser_heights(const Grid<float>& finer, const PlacedVertices& coarser) {
    Grid<float> heights = means_around(finer);
    ClosedStep(finer, coarser).close(heights);
    const glm::ivec2 last = level_cells(coarser.tree, coarser.level);
    if (!coarser.tree.wrap().around) {
        repeat_border_cols(heights, coarser.first.x, last.x);
    }
    repeat_border_rows(heights, coarser.first.y, last.y);
    return heights;
}

} // namespace reljef::terrain
