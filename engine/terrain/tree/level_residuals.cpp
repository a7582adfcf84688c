#include "engine/terrain/tree/level_residuals.h"

#include <algorithm>
#include <span>
#include <utility>

#include "engine/terrain/tree/level_step.h"

namespace reljef::terrain {
namespace {

// Between two heights; one that has no share may be a void.
float between(float a, float b, float share) {
    return share == 0.0F ? a : share == 1.0F ? b : (1.0F - share) * a + share * b;
}

/// A row of coarser vertices at all base vertices.
void spread(const float* coarser, const CoarserAxis& axis, std::vector<float>& row) {
    const float* const shares = axis.shares.data();
    const LoopOutput into = row.data();
    for (int cell = 0; cell < axis.cells; ++cell) {
        const int last = axis.last(cell);
        for (int i = axis.first(cell); i < last; ++i) {
            into[i] = between(coarser[cell], coarser[cell + 1], shares[i]);
        }
    }
    into[axis.vertices() - 1] = coarser[axis.cells];
}

/// Base heights minus the coarser surface, of a row of vertices. At voids, low > high.
struct Differences {
    std::vector<float> low;
    std::vector<float> high;

    /// `share`: of the lower row of the surface.
    void set(const float* heights, const std::vector<float>& above, const std::vector<float>& below,
             float share) {
        // Without a constant here, g++ 12 makes no vector code of the extremes.
        const float beyond = infinite;
        const float* const a = share == 1.0F ? below.data() : above.data();
        const float* const b = share == 0.0F ? above.data() : below.data();
        const float of_a = 1.0F - share;
        const LoopOutput into_low = low.data();
        const LoopOutput into_high = high.data();
        const bool is_between = share > 0.0F && share < 1.0F;
        for (std::size_t i = 0; i < low.size(); ++i) {
            const float surface = is_between ? of_a * a[i] + share * b[i] : a[i];
            const float difference = heights[i] - surface;
            into_low[i] = lower(beyond, difference);
            into_high[i] = higher(-beyond, difference);
        }
    }
};

/// Ranges of a row of coarser cells, at base vertices or cells.
struct Ranges {
    std::vector<float> low;
    std::vector<float> high;

    void clear() {
        std::fill(low.begin(), low.end(), infinite);
        std::fill(high.begin(), high.end(), -infinite);
    }
    void add_vertices(const Differences& row) {
        const float* const more_low = row.low.data();
        const float* const more_high = row.high.data();
        const LoopOutput into_low = low.data();
        const LoopOutput into_high = high.data();
        for (std::size_t i = 0; i < low.size(); ++i) {
            into_low[i] = lower(into_low[i], more_low[i]);
            into_high[i] = higher(into_high[i], more_high[i]);
        }
    }
    /// The base cells between two rows of vertices, with their own ranges.
    void add_cells(const Differences& above, const Differences& below, const float* own_low,
                   const float* own_high) {
        const float* const a = above.low.data();
        const float* const b = below.low.data();
        const float* const c = above.high.data();
        const float* const d = below.high.data();
        const LoopOutput into_low = low.data();
        const LoopOutput into_high = high.data();
        for (std::size_t i = 0; i + 1 < low.size(); ++i) {
            const float moved_down = lower(lower(a[i], a[i + 1]), lower(b[i], b[i + 1]));
            const float moved_up = higher(higher(c[i], c[i + 1]), higher(d[i], d[i + 1]));
            into_low[i] = lower(into_low[i], own_low[i] + moved_down);
            into_high[i] = higher(into_high[i], own_high[i] + moved_up);
        }
    }
    /// Joins those of each coarser cell, which the vertices on its sides belong to.
    void join(const CoarserAxis& axis, bool are_vertices, std::span<float> cells_low,
              std::span<float> cells_high) const {
        for (int cell = 0; cell < axis.cells; ++cell) {
            const int end = axis.last(cell) + (are_vertices ? 1 : 0);
            float lowest = infinite;
            float highest = -infinite;
            for (int i = axis.first(cell); i < end; ++i) {
                lowest = lower(lowest, low[static_cast<std::size_t>(i)]);
                highest = higher(highest, high[static_cast<std::size_t>(i)]);
            }
            cells_low[static_cast<std::size_t>(cell)] = lowest;
            cells_high[static_cast<std::size_t>(cell)] = highest;
        }
    }
};

class ResidualPass {
public:
    ResidualPass(const BorderedHeights& base, const BorderedHeights& coarser,
                 const std::array<CoarserAxis, 2>& axes)
        : base_(base), coarser_(coarser), cols_(axes[0]), rows_(axes[1]),
          above_(axes[0].shares.size()),
          below_(above_.size()), last_{above_, above_}, now_{above_, above_}, ranges_{above_,
                                                                                      above_} {}

    void run(Residuals& residuals) {
        spread_row(0, above_);
        for (int cell = 0; cell < rows_.cells; ++cell) {
            spread_row(cell + 1, below_);
            add_row(cell);
            ranges_.join(cols_, base_.residuals == nullptr, residuals.low.row(cell),
                         residuals.high.row(cell));
            std::swap(above_, below_);
        }
    }

private:
    void spread_row(int row, std::vector<float>& into) const {
        spread(coarser_.heights.row(row + coarser_.border).data() + coarser_.border, cols_, into);
    }

    void add_row(int cell) {
        ranges_.clear();
        const int first = rows_.first(cell);
        const int last = rows_.last(cell);
        for (int row = first; row <= last; ++row) {
            const float share = row == last ? 1.0F : rows_.shares[static_cast<std::size_t>(row)];
            now_.set(base_.heights.row(row + base_.border).data() + base_.border, above_, below_,
                     share);
            if (base_.residuals == nullptr) {
                ranges_.add_vertices(now_);
            } else if (row > first) {
                ranges_.add_cells(last_, now_, base_.residuals->low.row(row - 1).data(),
                                  base_.residuals->high.row(row - 1).data());
            }
            std::swap(last_, now_);
        }
    }

    const BorderedHeights& base_;
    const BorderedHeights& coarser_;
    const CoarserAxis& cols_;
    const CoarserAxis& rows_;
    std::vector<float> above_; // the coarser surface at base columns
    std::vector<float> below_;
    Differences last_;
    Differences now_;
    Ranges ranges_;
};

} // namespace

CoarserAxis coarser_axis(const AxisOfChunk& chunk) {
    CoarserAxis axis;
    axis.step = 1 << chunk.levels;
    const int last = std::min(chunk.base_last, chunk.cells * axis.step);
    axis.cells = (last + axis.step - 1) / axis.step;
    axis.shares.resize(static_cast<std::size_t>(last) + 1);
    const auto sample = [&](int vertex) {
        return std::min(vertex << chunk.base, chunk.last_sample);
    };
    for (int i = 0; i <= last; ++i) {
        const int first = i / axis.step * axis.step;
        const int width = sample(first + axis.step) - sample(first);
        axis.shares[static_cast<std::size_t>(i)] =
            width > 0 ? static_cast<float>(sample(i) - sample(first)) / static_cast<float>(width)
                      : 0.0F;
    }
    return axis;
}

Residuals residuals_over(const BorderedHeights& base, const BorderedHeights& coarser,
                         const std::array<CoarserAxis, 2>& axes, glm::ivec2 cells) {
    Residuals residuals{Grid<float>(cells.x, cells.y, infinite),
                        Grid<float>(cells.x, cells.y, -infinite)};
    ResidualPass(base, coarser, axes).run(residuals);
    return residuals;
}

} // namespace reljef::terrain
