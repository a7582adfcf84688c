#include "engine/terrain/field/heightfield.h"

#include <algorithm>
#include <limits>

#include <glm/common.hpp>

#include "engine/core/check.h"
#include "engine/core/parallel_for.h"

namespace reljef::terrain {
namespace {

/// The cell of a position, and the position inside it.
struct Cell {
    int col = 0;
    int row = 0;
    int next_col = 0;
    int next_row = 0;
    double u = 0.0;
    double v = 0.0;
};

Cell cell_at(int cols, int rows, glm::dvec2 sample) {
    const double x = sample.x > 0.0 ? std::min(sample.x, cols - 1.0) : 0.0; // NaN gives 0
    const double y = sample.y > 0.0 ? std::min(sample.y, rows - 1.0) : 0.0;
    Cell cell;
    cell.col = std::clamp(static_cast<int>(x), 0, std::max(cols - 2, 0));
    cell.row = std::clamp(static_cast<int>(y), 0, std::max(rows - 2, 0));
    cell.next_col = std::min(cell.col + 1, cols - 1);
    cell.next_row = std::min(cell.row + 1, rows - 1);
    cell.u = x - cell.col;
    cell.v = y - cell.row;
    return cell;
}

struct Level {
    Grid<float> average;
    Grid<float> weight; // share of known heights, [0,1]
};

/// The next coarser level: weighted averages of 2×2 samples. Weights are sums, at most 1.
template <class Average, class Weight>
Level pulled(int cols, int rows, const Average& average, const Weight& weight) {
    Level level{Grid<float>((cols + 1) / 2, (rows + 1) / 2),
                Grid<float>((cols + 1) / 2, (rows + 1) / 2)};
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
            const float w = weight(col, row);
            if (w > 0.0F) {
                level.average(col / 2, row / 2) += w * average(col, row);
                level.weight(col / 2, row / 2) += w;
            }
        }
    }
    for (std::size_t i = 0; i < level.weight.size(); ++i) {
        float& w = level.weight.samples()[i];
        level.average.samples()[i] /= w > 0.0F ? w : 1.0F;
        w = std::min(w, 1.0F);
    }
    return level;
}

/// The coarser level's value at a finer sample, bilinear.
float value_from(const Level& coarse, int col, int row) {
    const glm::dvec2 sample(0.5 * col - 0.25, 0.5 * row - 0.25);
    return static_cast<float>(bilinear_height(coarse.average.view(), sample));
}

std::vector<Level> pyramid_of(const Grid<float>& heights, const Grid<std::uint8_t>& void_mask) {
    std::vector<Level> levels;
    levels.push_back(pulled(heights.cols(), heights.rows(), heights, [&](int col, int row) {
        return void_mask(col, row) != 0 ? 0.0F : 1.0F;
    }));
    while (levels.back().average.cols() > 1 || levels.back().average.rows() > 1) {
        const Level& last = levels.back();
        levels.push_back(
            pulled(last.average.cols(), last.average.rows(), last.average, last.weight));
    }
    return levels;
}

/// The samples of a grid without a known height.
class OpenSamples {
public:
    template <class IsOpen> OpenSamples(int cols, int rows, const IsOpen& is_open) {
        for (int row = 0; row < rows; ++row) {
            int end = 0;
            for (int col = 0; col < cols; col = end) {
                for (end = col; end < cols && is_open(end, row);) {
                    ++end;
                }
                if (end > col) {
                    runs_.push_back({row, col, end});
                    count_ += static_cast<std::size_t>(end - col);
                }
                end = std::max(end, col + 1);
            }
        }
    }

    template <class Visit> void for_each(const Visit& visit) const {
        for (const Run& run : runs_) {
            for (int col = run.first; col < run.end; ++col) {
                visit(col, run.row);
            }
        }
    }

    /// Successive over-relaxation (Young 1954): each sample approaches the mean of its neighbours.
    /// At most as many sweeps as there are samples.
    void relax(Grid<float>& heights, int sweeps, const HeightRange& range) const {
        const int needed = static_cast<int>(std::min(count_, static_cast<std::size_t>(sweeps)));
        for (int sweep = 0; sweep < needed; ++sweep) {
            // Every other sample, and then the others: the result does not depend on the order.
            relax_color(heights, 0, range);
            relax_color(heights, 1, range);
        }
    }

private:
    struct Run {
        int row = 0;
        int first = 0;
        int end = 0; ///< the column after its last one
    };

    void relax_color(Grid<float>& heights, int color, const HeightRange& range) const {
        constexpr std::size_t per_part = 1U << 16U; // a thread costs as much as some thousands
        const auto parts = static_cast<int>(1 + std::min(count_ / per_part, runs_.size() / 4));
        const auto bound = [&](int part) {
            return runs_.size() * static_cast<std::size_t>(part) / static_cast<std::size_t>(parts);
        };
        const auto relax_part = [&](int part) {
            for (std::size_t i = bound(part); i < bound(part + 1); ++i) {
                relax_run(heights, runs_[i], color, range);
            }
        };
        parallel_for(parts, relax_part,
                     {.threads = parts > 1 ? 0U : 1U, .stop = {}, .progress = {}});
    }
    static void relax_run(Grid<float>& heights, const Run& run, int color,
                          const HeightRange& range) {
        constexpr float over = 1.5F;
        const auto low = static_cast<float>(range.low);
        const auto high = static_cast<float>(range.high);
        for (int col = run.first + ((run.first + run.row + color) & 1); col < run.end; col += 2) {
            const float mean =
                0.25F * (heights.clamped(col - 1, run.row) + heights.clamped(col + 1, run.row) +
                         heights.clamped(col, run.row - 1) + heights.clamped(col, run.row + 1));
            float& height = heights(col, run.row);
            height = std::clamp(height + over * (mean - height), low, high);
        }
    }

    std::vector<Run> runs_;
    std::size_t count_ = 0;
};

/// Fills the open samples of a level from the next coarser one. Sweeps cost less on coarse levels.
void fill_level(const Level& coarse, std::size_t level, Grid<float>& heights,
                const OpenSamples& open, const HeightRange& range) {
    constexpr std::size_t max_doublings = 5;
    const int sweeps = 16 << std::min(level, max_doublings);
    open.for_each([&](int col, int row) { heights(col, row) = value_from(coarse, col, row); });
    open.relax(heights, sweeps, range);
}

} // namespace

HeightRange height_range(const Grid<float>& heights, const Grid<std::uint8_t>& void_mask) {
    check(void_mask.empty() || void_mask.size() == heights.size(), "void mask of another size");
    float low = std::numeric_limits<float>::infinity();
    float high = -low;
    for (std::size_t i = 0; i < heights.size(); ++i) {
        if (void_mask.empty() || void_mask.samples()[i] == 0) {
            low = std::min(low, heights.samples()[i]);
            high = std::max(high, heights.samples()[i]);
        }
    }
    return low <= high ? HeightRange{low, high} : HeightRange{};
}

Grid<float> unit_heights(GridView<const float> heights) {
    Grid<float> unit(heights.cols(), heights.rows());
    float low = std::numeric_limits<float>::infinity();
    float high = -low;
    for (int row = 0; row < heights.rows(); ++row) {
        for (const float height : heights.row(row)) {
            low = std::min(low, height);
            high = std::max(high, height);
        }
    }
    const double range = high > low ? static_cast<double>(high) - low : 1.0;
    for (int row = 0; row < heights.rows(); ++row) {
        std::transform(heights.row(row).begin(), heights.row(row).end(), unit.row(row).begin(),
                       [&](float height) {
                           return static_cast<float>((static_cast<double>(height) - low) / range);
                       });
    }
    return unit;
}

double bilinear_height(GridView<const float> heights, glm::dvec2 sample) {
    check(!heights.empty(), "bilinear_height of an empty grid");
    const Cell cell = cell_at(heights.cols(), heights.rows(), sample);
    const double top =
        (1.0 - cell.u) * heights(cell.col, cell.row) + cell.u * heights(cell.next_col, cell.row);
    const double bottom = (1.0 - cell.u) * heights(cell.col, cell.next_row) +
                          cell.u * heights(cell.next_col, cell.next_row);
    return (1.0 - cell.v) * top + cell.v * bottom;
}

// Cells are extreme at the corners of their parts.
HeightRange surface_range(GridView<const float> heights, glm::dvec2 first, glm::dvec2 last) {
    check(!heights.empty(), "surface_range of an empty grid");
    check(first.x <= last.x && first.y <= last.y, "surface_range between exchanged places");
    const glm::dvec2 end(heights.cols() - 1, heights.rows() - 1);
    const glm::dvec2 low = glm::clamp(first, glm::dvec2(0.0), end);
    const glm::dvec2 high = glm::clamp(last, glm::dvec2(0.0), end);
    const glm::ivec2 first_vertex(glm::floor(low));
    const glm::ivec2 last_vertex(glm::ceil(high));
    const bool is_of_whole_cells =
        glm::dvec2(first_vertex) == low && glm::dvec2(last_vertex) == high;
    HeightRange range{std::numeric_limits<double>::infinity(),
                      -std::numeric_limits<double>::infinity()};
    for (int row = first_vertex.y; row <= last_vertex.y; ++row) {
        for (int col = first_vertex.x; col <= last_vertex.x; ++col) {
            const double height =
                is_of_whole_cells
                    ? static_cast<double>(heights(col, row))
                    : bilinear_height(heights, glm::clamp(glm::dvec2(col, row), low, high));
            range = {std::min(range.low, height), std::max(range.high, height)};
        }
    }
    return range;
}

bool uses_void(const Heightfield& heightfield, glm::dvec2 sample) {
    const Grid<std::uint8_t>& mask = heightfield.void_mask;
    if (mask.empty()) {
        return false;
    }
    const Cell cell = cell_at(mask.cols(), mask.rows(), sample);
    const bool left = cell.u < 1.0;
    const bool right = cell.u > 0.0;
    const bool top = cell.v < 1.0;
    const bool bottom = cell.v > 0.0;
    return (left && top && mask(cell.col, cell.row) != 0) ||
           (right && top && mask(cell.next_col, cell.row) != 0) ||
           (left && bottom && mask(cell.col, cell.next_row) != 0) ||
           (right && bottom && mask(cell.next_col, cell.next_row) != 0);
}

void fill_voids(Grid<float>& heights, const Grid<std::uint8_t>& void_mask) {
    check(void_mask.empty() ||
              (void_mask.cols() == heights.cols() && void_mask.rows() == heights.rows()),
          "void mask of another size");
    const auto mask = void_mask.samples();
    if (std::all_of(mask.begin(), mask.end(), [](std::uint8_t is_void) { return is_void == 0; })) {
        return;
    }
    const HeightRange range = height_range(heights, void_mask);
    std::vector<Level> levels = pyramid_of(heights, void_mask);
    for (std::size_t i = levels.size() - 1; i > 0; --i) {
        Level& fine = levels[i - 1];
        const OpenSamples open(fine.average.cols(), fine.average.rows(),
                               [&](int col, int row) { return fine.weight(col, row) == 0.0F; });
        fill_level(levels[i], i, fine.average, open, range);
    }
    const OpenSamples open(heights.cols(), heights.rows(),
                           [&](int col, int row) { return void_mask(col, row) != 0; });
    fill_level(levels.front(), 0, heights, open, range);
}

} // namespace reljef::terrain
