#include "engine/terrain/tree/level_step.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include <glm/common.hpp>

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

} // namespace

Grid<float> coarser_heights(const Grid<float>& finer) {
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

void repeat_border(Grid<float>& heights, glm::ivec2 first, glm::ivec2 last) {
    const glm::ivec2 end = first + glm::ivec2(heights.cols(), heights.rows()) - 1;
    if (first.x >= 0 && first.y >= 0 && end.x <= last.x && end.y <= last.y) {
        return;
    }
    const int begin = std::max(0, -first.x);
    const int count = std::min(end.x, last.x) - first.x + 1;
    for (int row = 0; row < heights.rows(); ++row) {
        const auto cells = heights.row(row);
        std::fill(cells.begin(), cells.begin() + begin, cells[static_cast<std::size_t>(begin)]);
        std::fill(cells.begin() + count, cells.end(), cells[static_cast<std::size_t>(count - 1)]);
    }
    for (int row = 0; row < heights.rows(); ++row) {
        const int inside = std::clamp(first.y + row, 0, last.y) - first.y;
        if (inside != row) {
            std::copy(heights.row(inside).begin(), heights.row(inside).end(),
                      heights.row(row).begin());
        }
    }
}

} // namespace reljef::terrain
