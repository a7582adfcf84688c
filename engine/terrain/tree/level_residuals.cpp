#include "engine/terrain/tree/level_residuals.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "engine/terrain/tree/level_step.h"
#include "engine/terrain/tree/tile_error.h"

namespace reljef::terrain {
namespace {

// Between two heights; one that has no share may be a void.
float between(float a, float b, float share) {
    return share == 0.0F ? a : share == 1.0F ? b : (1.0F - share) * a + share * b;
}

/// A row of coarser vertices at all base vertices.
template <int step>
void spread(const float* coarser, const CoarserAxis& axis, std::vector<float>& row) {
    const float* const shares = axis.shares.data();
    const LoopOutput into = row.data();
    const int whole = (axis.vertices() - 1) / step; // cells; all but the first have shares of both
    for (int cell = 0; cell < whole; ++cell) {
        const int first = cell * step;
        into[first] = coarser[cell];
        for (int i = first + 1; i < first + step; ++i) {
            into[i] = (1.0F - shares[i]) * coarser[cell] + shares[i] * coarser[cell + 1];
        }
    }
    for (int i = whole * step; i < axis.vertices() - 1; ++i) {
        into[i] = between(coarser[whole], coarser[whole + 1], shares[i]);
    }
    into[axis.vertices() - 1] = coarser[axis.cells];
}

void spread(const float* coarser, const CoarserAxis& axis, std::vector<float>& row) {
    static_assert(levels_per_chunk == 3); // so there are no other steps
    if (axis.step == 2) {
        spread<2>(coarser, axis, row);
    } else if (axis.step == 4) {
        spread<4>(coarser, axis, row);
    } else {
        spread<8>(coarser, axis, row);
    }
}

/// The coarser surface at a row of base vertices, between two of its own rows.
struct SurfaceRow {
    const float* above;
    const float* below;
    float share; // of the row below, which may be a void if it has none
};

// Calls `use` with the index and the difference of each vertex: its height minus the surface.
template <class Use>
void for_differences(const float* heights, const SurfaceRow& surface, std::size_t count,
                     const Use& use) {
    const float* const a = surface.share == 1.0F ? surface.below : surface.above;
    const float* const b = surface.below;
    const float of_b = surface.share;
    const float of_a = 1.0F - of_b;
    if (of_b == 0.0F || of_b == 1.0F) {
        for (std::size_t i = 0; i < count; ++i) {
            use(i, heights[i] - a[i]);
        }
    } else {
        for (std::size_t i = 0; i < count; ++i) {
            use(i, heights[i] - (of_a * a[i] + of_b * b[i]));
        }
    }
}

/// Base heights minus the coarser surface, of a row of vertices. At voids, low > high.
struct Differences {
    std::vector<float> low;
    std::vector<float> high;

    void set(const float* heights, const SurfaceRow& surface) {
        // Without a constant here, g++ 12 makes no vector code of the extremes.
        const float beyond = infinite;
        const LoopOutput into_low = low.data();
        const LoopOutput into_high = high.data();
        for_differences(heights, surface, low.size(), [=](std::size_t i, float difference) {
            into_low[i] = lower(beyond, difference);
            into_high[i] = higher(-beyond, difference);
        });
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
    /// Of a row of vertices alone.
    void set(const Differences& row) {
        low = row.low;
        high = row.high;
    }
    void add(const float* heights, const SurfaceRow& surface) {
        const LoopOutput into_low = low.data();
        const LoopOutput into_high = high.data();
        for_differences(heights, surface, low.size(), [=](std::size_t i, float difference) {
            into_low[i] = lower(into_low[i], difference);
            into_high[i] = higher(into_high[i], difference);
        });
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
};

/// Joins the ranges of each coarser cell.
class CellJoiner {
public:
    explicit CellJoiner(const CoarserAxis& axis)
        : step_(axis.step),
          values_(static_cast<std::size_t>(axis.cells) * static_cast<std::size_t>(axis.step)),
          spare_(values_.size()) {}

    /// `extreme`: lower or higher. `of_vertices`: those on the sides of cells belong to both.
    template <class Extreme>
    void join(const std::vector<float>& row, bool of_vertices, Extreme extreme, float* into) {
        const float* const from = row.data();
        const LoopOutput to = values_.data();
        const std::size_t end = row.size() - 1; // base cells; the raster may cut the last one
        if (of_vertices) {
            for (std::size_t i = 0; i < end; ++i) {
                to[i] = extreme(from[i], from[i + 1]);
            }
        } else {
            std::copy_n(from, end, to);
        }
        std::fill(values_.begin() + static_cast<std::ptrdiff_t>(end), values_.end(), from[end - 1]);
        std::size_t count = values_.size();
        for (int width = step_; width > 1; width /= 2) {
            count /= 2;
            halve(count, extreme);
        }
        std::copy_n(values_.data(), count, into);
    }

private:
    template <class Extreme> void halve(std::size_t count, Extreme extreme) {
        const float* const from = values_.data();
        const LoopOutput to = spare_.data();
        for (std::size_t i = 0; i < count; ++i) {
            to[i] = extreme(from[2 * i], from[2 * i + 1]);
        }
        std::swap(values_, spare_);
    }

    int step_;
    std::vector<float> values_;
    std::vector<float> spare_;
};

class ResidualPass {
public:
    ResidualPass(const BorderedHeights& base, const BorderedHeights& coarser,
                 const std::array<CoarserAxis, 2>& axes)
        : base_(base), coarser_(coarser), cols_(axes[0]), rows_(axes[1]),
          above_(axes[0].shares.size()),
          below_(above_.size()), last_{above_, above_}, now_{above_, above_}, ranges_{above_,
                                                                                      above_},
          joiner_(axes[0]) {}

    void run(Residuals& residuals) {
        spread_row(0, above_);
        last_.set(heights_of(0), surface_at(0.0F));
        for (int cell = 0; cell < rows_.cells; ++cell) {
            spread_row(cell + 1, below_);
            if (base_.residuals == nullptr) {
                add_vertices(cell);
            } else {
                add_cells(cell);
            }
            const bool of_vertices = base_.residuals == nullptr;
            joiner_.join(
                ranges_.low, of_vertices, [](float a, float b) { return lower(a, b); },
                residuals.low.row(cell).data());
            joiner_.join(
                ranges_.high, of_vertices, [](float a, float b) { return higher(a, b); },
                residuals.high.row(cell).data());
            std::swap(above_, below_);
        }
    }

private:
    void spread_row(int row, std::vector<float>& into) const {
        spread(coarser_.heights.row(row + coarser_.border).data() + coarser_.border, cols_, into);
    }
    [[nodiscard]] const float* heights_of(int row) const {
        return base_.heights.row(row + base_.border).data() + base_.border;
    }
    [[nodiscard]] SurfaceRow surface_at(float share) const {
        return {above_.data(), below_.data(), share};
    }
    [[nodiscard]] float share_of(int row) const {
        return rows_.shares[static_cast<std::size_t>(row)];
    }

    // `last_` is the row above the cells, and becomes that below them.
    void add_vertices(int cell) {
        ranges_.set(last_);
        const int last = rows_.last(cell);
        for (int row = rows_.first(cell) + 1; row < last; ++row) {
            ranges_.add(heights_of(row), surface_at(share_of(row)));
        }
        ranges_.add(heights_of(last), surface_at(1.0F));
        last_.set(heights_of(last), surface_at(1.0F));
    }
    void add_cells(int cell) {
        ranges_.clear();
        const int last = rows_.last(cell);
        for (int row = rows_.first(cell) + 1; row <= last; ++row) {
            now_.set(heights_of(row), surface_at(row == last ? 1.0F : share_of(row)));
            ranges_.add_cells(last_, now_, base_.residuals->low.row(row - 1).data(),
                              base_.residuals->high.row(row - 1).data());
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
    CellJoiner joiner_;
};

} // namespace

CoarserAxis coarser_axis(const TileTree& tree, Chunk chunk, int levels, int axis) {
    CoarserAxis found;
    found.step = 1 << levels;
    const int corner = first_vertex(chunk)[axis];
    const int last =
        std::min(level_cells(tree, chunk.base)[axis] - corner, chunk_size(tree, chunk)[axis]);
    found.cells = (last + found.step - 1) / found.step;
    found.shares.resize(static_cast<std::size_t>(last) + 1);
    const glm::ivec2 end = glm::ivec2(tree.cols(), tree.rows()) - 1;
    const auto place = [&](int vertex) {
        glm::ivec2 sample(0);
        sample[axis] = std::min((corner + vertex) << chunk.base, end[axis]);
        return tree.place(sample)[axis];
    };
    for (int i = 0; i <= last; ++i) {
        const double first = place(i / found.step * found.step);
        const double width = place(i / found.step * found.step + found.step) - first;
        found.shares[static_cast<std::size_t>(i)] =
            width > 0.0 ? static_cast<float>((place(i) - first) / width) : 0.0F;
    }
    return found;
}

Residuals residuals_over(const BorderedHeights& base, const BorderedHeights& coarser,
                         const std::array<CoarserAxis, 2>& axes, glm::ivec2 cells) {
    Residuals residuals{Grid<float>(cells.x, cells.y, infinite),
                        Grid<float>(cells.x, cells.y, -infinite)};
    ResidualPass(base, coarser, axes).run(residuals);
    return residuals;
}

} // namespace reljef::terrain
