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

// The loops below run over plain pointers, and what they write overlaps nothing else: otherwise
// checks of bounds and of overlaps keep them from becoming vector code.
using Output = float* __restrict;

void split(std::span<const float> row, SplitRow& into) {
    const std::size_t count = into.on.size();
    const float* const from = row.data();
    const Output between = into.between.data();
    const Output on = into.on.data();
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
    const Output sum = sums.data();
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
    const Output means = coarse.data();
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

/// Finer vertices of a row minus the coarser surface. At voids, low > high.
struct Differences {
    SplitRow low;
    SplitRow high;

    explicit Differences(std::size_t coarse) : low(coarse), high(coarse) {}

    /// `coarse`: the surface at the row; `cut`: index of a cut cell, as its left vertex.
    void set(const SplitRow& row, std::span<const float> coarse, LastCell cut) {
        const std::size_t count = coarse.size();
        const float* const surface = coarse.data();
        set_on(row.on.data(), surface, count);
        set_between(row.between.data() + 1, surface, count - 1);
        if (cut.cell >= 0) {
            const auto i = static_cast<std::size_t>(cut.cell) + 1;
            const float difference = row.between[i] - mixed(coarse[i - 1], coarse[i], cut.share);
            low.between[i] = lower(beyond_, difference);
            high.between[i] = higher(-beyond_, difference);
        }
    }

private:
    void set_on(const float* heights, const float* surface, std::size_t count) {
        const float beyond = beyond_;
        const Output low_on = low.on.data();
        const Output high_on = high.on.data();
        for (std::size_t i = 0; i < count; ++i) {
            const float difference = heights[i] - surface[i];
            low_on[i] = lower(beyond, difference);
            high_on[i] = higher(-beyond, difference);
        }
    }
    void set_between(const float* heights, const float* surface, std::size_t count) {
        const float beyond = beyond_;
        const Output low_between = low.between.data() + 1;
        const Output high_between = high.between.data() + 1;
        for (std::size_t i = 0; i < count; ++i) {
            const float difference = heights[i] - 0.5F * (surface[i] + surface[i + 1]);
            low_between[i] = lower(beyond, difference);
            high_between[i] = higher(-beyond, difference);
        }
    }

    float beyond_ = infinite; // a known ∞ keeps g++ 12 from the instructions for extremes
};

struct Lower {
    float operator()(float a, float b) const { return lower(a, b); }
};
struct Higher {
    float operator()(float a, float b) const { return higher(a, b); }
};

using SplitRows = std::array<const SplitRow*, 3>;

/// The extremes of three rows of differences; cell 0 is right of vertex `first`.
template <class Extreme>
void extremes_of(const SplitRows& rows, std::size_t first, Extreme extreme, SplitRow& into) {
    const std::size_t cells = into.on.size() - 1;
    const Output on = into.on.data();
    const Output between = into.between.data();
    const auto [a, b, c] = rows;
    const float* const on_a = a->on.data() + first;
    const float* const on_b = b->on.data() + first;
    const float* const on_c = c->on.data() + first;
    for (std::size_t i = 0; i <= cells; ++i) {
        on[i] = extreme(extreme(on_a[i], on_b[i]), on_c[i]);
    }
    const float* const between_a = a->between.data() + first + 1;
    const float* const between_b = b->between.data() + first + 1;
    const float* const between_c = c->between.data() + first + 1;
    for (std::size_t i = 0; i < cells; ++i) {
        between[i] = extreme(extreme(between_a[i], between_b[i]), between_c[i]);
    }
}

/// The extreme in each cell.
template <class Extreme>
void join_vertices(const SplitRow& vertices, Extreme extreme, std::span<float> cells) {
    const float* const on = vertices.on.data();
    const float* const between = vertices.between.data();
    const Output into = cells.data();
    for (std::size_t i = 0; i < cells.size(); ++i) {
        into[i] = extreme(extreme(on[i], on[i + 1]), between[i]);
    }
}

/// The extreme in each cell of its two finer cells' own extremes, moved by those of the vertices.
template <class Extreme>
void join_cells(const SplitRow& vertices, std::span<const float> finer, Extreme extreme,
                std::span<float> cells) {
    const float* const on = vertices.on.data();
    const float* const between = vertices.between.data();
    const float* const own = finer.data();
    const Output into = cells.data();
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const float left = own[2 * i] + extreme(on[i], between[i]);
        const float right = own[2 * i + 1] + extreme(on[i + 1], between[i]);
        into[i] = extreme(into[i], extreme(left, right));
    }
}

/// Computes a level of a chunk from the finer one, row by row.
class LevelStep {
public:
    /// `cells`: of the chunk at the coarser level; `inside`: those on the raster.
    LevelStep(const FinerLevel& finer, glm::ivec2 cells, glm::ivec2 inside,
              const std::array<LastCell, 2>& cuts)
        : finer_(finer), count_(static_cast<std::size_t>(finer.vertices.x / 2)), inside_(inside),
          cut_cols_(cuts[0]), cut_rows_(cuts[1]), line_(2 * count_ + 1), sums_(count_),
          middle_(count_), extremes_(static_cast<std::size_t>(inside.x) + 1),
          rows_(4, SplitRow(count_)), differences_(3, Differences(count_)) {
        const int rows = finer.vertices.y / 2;
        level_.heights = Grid<float>(static_cast<int>(count_), rows);
        level_.border = (rows - cells.y - 1) / 2;
        cut_cols_.cell += cut_cols_.cell >= 0 ? level_.border : 0;
        level_.residuals = {Grid<float>(cells.x, cells.y, infinite),
                            Grid<float>(cells.x, cells.y, -infinite)};
    }

    ChunkLevel run() && {
        load(0);
        for (int row = 0; row < level_.heights.rows(); ++row) {
            load(2 * row + 1);
            load(2 * row + 2);
            coarsen({&finer(2 * row), &finer(2 * row + 1), &finer(2 * row + 2)}, sums_,
                    level_.heights.row(row));
            differences_at(2 * row + 1).set(finer(2 * row + 1), level_.heights.row(row), cut_cols_);
            const int cell = row - 1 - level_.border;
            if (cell >= 0 && cell < inside_.y) {
                set_middle(row, cell);
                add_cell_row(row, cell);
            }
        }
        return std::move(level_);
    }

private:
    void load(int row) {
        finer_.rows(row, line_);
        split(line_, finer(row));
    }
    SplitRow& finer(int row) { return rows_[static_cast<std::size_t>(row % 4)]; }
    Differences& differences_at(int row) { return differences_[static_cast<std::size_t>(row % 3)]; }

    /// Differences of the finer row between the coarser rows `row` - 1 and `row`.
    void set_middle(int row, int cell) {
        const auto above = level_.heights.row(row - 1);
        const auto below = level_.heights.row(row);
        const float* const a = above.data();
        const float* const b = below.data();
        const Output middle = middle_.data();
        for (std::size_t i = 0; i < count_; ++i) {
            middle[i] = 0.5F * (a[i] + b[i]);
        }
        for (std::size_t i = 0; cell == cut_rows_.cell && i < count_; ++i) {
            middle_[i] = mixed(above[i], below[i], cut_rows_.share);
        }
        differences_at(2 * row).set(finer(2 * row), middle_, cut_cols_);
    }

    void add_cell_row(int row, int cell) {
        const auto cols = static_cast<std::size_t>(inside_.x);
        const auto low = level_.residuals.low.row(cell).first(cols);
        const auto high = level_.residuals.high.row(cell).first(cols);
        const std::array rows{&differences_at(2 * row - 1), &differences_at(2 * row),
                              &differences_at(2 * row + 1)};
        const Residuals* const finer = finer_.residuals;
        add_extremes({&rows[0]->low, &rows[1]->low, &rows[2]->low}, cell, Lower(), low,
                     finer != nullptr ? &finer->low : nullptr);
        add_extremes({&rows[0]->high, &rows[1]->high, &rows[2]->high}, cell, Higher(), high,
                     finer != nullptr ? &finer->high : nullptr);
    }

    template <class Extreme>
    void add_extremes(const SplitRows& rows, int cell, Extreme extreme, std::span<float> cells,
                      const Grid<float>* finer) {
        const auto first = static_cast<std::size_t>(level_.border);
        if (finer == nullptr) {
            extremes_of(rows, first, extreme, extremes_);
            join_vertices(extremes_, extreme, cells);
            return;
        }
        extremes_of({rows[0], rows[1], rows[1]}, first, extreme, extremes_);
        join_cells(extremes_, finer->row(2 * cell), extreme, cells);
        extremes_of({rows[1], rows[2], rows[2]}, first, extreme, extremes_);
        join_cells(extremes_, finer->row(2 * cell + 1), extreme, cells);
    }

    const FinerLevel& finer_;
    std::size_t count_; // coarser vertices of a row
    glm::ivec2 inside_;
    LastCell cut_cols_; // index of its left vertex
    LastCell cut_rows_;
    std::vector<float> line_;
    SplitRow sums_;
    std::vector<float> middle_;
    SplitRow extremes_;                    // of a row of cells
    std::vector<SplitRow> rows_;           // by row modulo 4
    std::vector<Differences> differences_; // by row modulo 3
    ChunkLevel level_;
};

} // namespace

float mixed(float a, float b, double share) {
    return share == 1.0 ? b : static_cast<float>(glm::mix<double>(a, b, share));
}

ChunkLevel coarser_level(const FinerLevel& finer, glm::ivec2 cells, glm::ivec2 inside,
                         const std::array<LastCell, 2>& cuts) {
    return LevelStep(finer, cells, inside, cuts).run();
}

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
