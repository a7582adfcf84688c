#include "engine/material/cone_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace reljef::material {
namespace {

struct Bounds {
    float low = 0.0F;
    float high = 0.0F;
};

Bounds joined(Bounds a, Bounds b) {
    return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

// Bounds over a block of cells: heights, and slopes per sample along columns and rows.
struct Relief {
    Bounds height;
    Bounds east;
    Bounds south;
};

Relief joined(const Relief& a, const Relief& b) {
    return {joined(a.height, b.height), joined(a.east, b.east), joined(a.south, b.south)};
}

// A bilinear patch's slope along one axis is linear along the other.
Relief relief_of_cell(GridView<const float> heights, int col, int row) {
    const float h00 = heights(col, row);
    const float h10 = heights(col + 1, row);
    const float h01 = heights(col, row + 1);
    const float h11 = heights(col + 1, row + 1);
    const auto height = std::minmax({h00, h10, h01, h11});
    const auto east = std::minmax({h10 - h00, h11 - h01});
    const auto south = std::minmax({h01 - h00, h11 - h10});
    return {{height.first, height.second}, {east.first, east.second}, {south.first, south.second}};
}

// Bounds over blocks of 2^level × 2^level cells. Those of the cells are not stored, only their
// heights.
class ReliefPyramid {
public:
    // `heights` outlive the pyramid.
    explicit ReliefPyramid(GridView<const float> heights) : heights_(heights) {
        levels_.push_back(halved(cells(), [&](int col, int row) { return cell({col, row}); }));
        while (levels_.back().size() > 1) {
            const Grid<Relief>& fine = levels_.back();
            levels_.push_back(
                halved({fine.cols(), fine.rows()},
                       [&](int col, int row) -> const Relief& { return fine(col, row); }));
        }
    }

    [[nodiscard]] glm::ivec2 cells() const { return {heights_.cols() - 1, heights_.rows() - 1}; }
    [[nodiscard]] int last_level() const { return static_cast<int>(levels_.size()); }
    // Precondition: 0 to last_level().
    [[nodiscard]] glm::ivec2 size(int level) const {
        return level == 0 ? cells() : glm::ivec2(stored(level).cols(), stored(level).rows());
    }
    [[nodiscard]] Relief cell(glm::ivec2 at) const { return relief_of_cell(heights_, at.x, at.y); }
    [[nodiscard]] Relief block(int level, glm::ivec2 at) const {
        return level == 0 ? cell(at) : stored(level)(at.x, at.y);
    }
    [[nodiscard]] Grid<Relief> window(glm::ivec2 begin, glm::ivec2 end) const {
        Grid<Relief> window(end.x - begin.x, end.y - begin.y);
        for (int row = 0; row < window.rows(); ++row) {
            for (int col = 0; col < window.cols(); ++col) {
                window(col, row) = cell(begin + glm::ivec2(col, row));
            }
        }
        return window;
    }

private:
    [[nodiscard]] const Grid<Relief>& stored(int level) const {
        return levels_[static_cast<std::size_t>(level) - 1];
    }
    template <class At> static Grid<Relief> halved(glm::ivec2 size, const At& at) {
        Grid<Relief> coarse((size.x + 1) / 2, (size.y + 1) / 2);
        for (int row = 0; row < coarse.rows(); ++row) {
            for (int col = 0; col < coarse.cols(); ++col) {
                const glm::ivec2 first(2 * col, 2 * row);
                const glm::ivec2 last = glm::min(first + 1, size - 1);
                coarse(col, row) = joined(joined(at(first.x, first.y), at(last.x, first.y)),
                                          joined(at(first.x, last.y), at(last.x, last.y)));
            }
        }
        return coarse;
    }

    GridView<const float> heights_;
    std::vector<Grid<Relief>> levels_; // from level 1
};

float max_slope(const Relief& relief) {
    const float east = std::max(-relief.east.low, relief.east.high);
    const float south = std::max(-relief.south.low, relief.south.high);
    return std::hypot(east, south);
}

float variation(const Relief& relief) {
    return std::hypot(relief.east.high - relief.east.low, relief.south.high - relief.south.low);
}

Grid<Relief> widened(const Grid<Relief>& cells) {
    Grid<Relief> along(cells.cols(), cells.rows());
    Grid<Relief> wide(cells.cols(), cells.rows());
    for (int row = 0; row < cells.rows(); ++row) {
        for (int col = 0; col < cells.cols(); ++col) {
            along(col, row) = joined(joined(cells.clamped(col - 1, row), cells(col, row)),
                                     cells.clamped(col + 1, row));
        }
    }
    for (int row = 0; row < cells.rows(); ++row) {
        for (int col = 0; col < cells.cols(); ++col) {
            wide(col, row) = joined(joined(along.clamped(col, row - 1), along(col, row)),
                                    along.clamped(col, row + 1));
        }
    }
    return wide;
}

// Bound of the mean slope from a tip to a point that limits its cone, both in this block: the
// steepest slope. Where the surface falls at the end, also the variation of the gradient.
float slope_bound(const Relief& block, ConeKind kind) {
    const float slope = max_slope(block);
    return kind == ConeKind::plain ? slope : std::min(slope, variation(block));
}

// Up to this distance in cells slopes bound a rise better than minimum and maximum heights do: the
// cells' own extents are a large part of the distance.
constexpr int near_cells = 8;

// Bounds of slopes around some cells.
struct SlopeBounds {
    glm::ivec2 begin{0};            // cell
    std::vector<Grid<float>> grids; // element n: for cells up to n away
};

// Valid for the cells `first` to `last`.
SlopeBounds slope_bounds(const ReliefPyramid& pyramid, ConeKind kind, glm::ivec2 first,
                         glm::ivec2 last) {
    SlopeBounds bounds{glm::max(first - near_cells, glm::ivec2(0)), {}};
    Grid<Relief> blocks =
        pyramid.window(bounds.begin, glm::min(last + near_cells + 1, pyramid.cells()));
    for (int n = 0; n <= near_cells; ++n) {
        Grid<float> slopes(blocks.cols(), blocks.rows());
        for (std::size_t i = 0; i < blocks.size(); ++i) {
            slopes.samples()[i] = slope_bound(blocks.samples()[i], kind);
        }
        bounds.grids.push_back(std::move(slopes));
        blocks = widened(blocks);
    }
    return bounds;
}

float min_product(Bounds a, Bounds b) {
    return std::min({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
}

// A quadrant of directions, mirrored so that both components are >= 0.
struct Quadrant {
    int east;
    int south;
};
constexpr std::array<Quadrant, 4> quadrants{{{1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};

Bounds mirrored(Bounds bounds, int sign) {
    return sign > 0 ? bounds : Bounds{-bounds.high, -bounds.low};
}

// Directions between two unit vectors of the quadrant, from east (1, 0) to south (0, 1).
struct Fan {
    glm::vec2 from{0.0F};
    glm::vec2 to{0.0F};
};

// The directions in which a cell may fall.
std::optional<Fan> falling(const Relief& cell, Quadrant quadrant) {
    const float east = mirrored(cell.east, quadrant.east).low;
    const float south = mirrored(cell.south, quadrant.south).low;
    if (east >= 0.0F && south >= 0.0F) {
        return std::nullopt;
    }
    Fan fan{{1.0F, 0.0F}, {0.0F, 1.0F}};
    if (east > 0.0F) {
        fan.from = glm::normalize(glm::vec2(-south, east));
    } else if (south > 0.0F) {
        fan.to = glm::normalize(glm::vec2(south, -east));
    }
    return fan;
}

float cross(glm::vec2 a, glm::vec2 b) {
    return a.x * b.y - a.y * b.x;
}

// The steepest possible rise of a cell in a direction of the fan.
float max_slope_in(const Relief& cell, Quadrant quadrant, const Fan& fan) {
    const glm::vec2 slope(mirrored(cell.east, quadrant.east).high,
                          mirrored(cell.south, quadrant.south).high);
    const bool inside = cross(fan.from, slope) >= 0.0F && cross(slope, fan.to) >= 0.0F;
    return inside ? glm::length(slope)
                  : std::max(glm::dot(slope, fan.from), glm::dot(slope, fan.to));
}

// Covers the rounding error of a float sum of a few products.
constexpr float rounding = 1.0F - 0x1p-20F;

// The ratio of a cone over ground with this largest slope.
float ratio_of(float slope) {
    return slope > 0.0F ? 1.0F / slope : std::numeric_limits<float>::infinity();
}

class ConeFinder {
public:
    ConeFinder(const ReliefPyramid& pyramid, const SlopeBounds& slopes, ConeKind kind)
        : pyramid_(pyramid), slopes_(slopes), relaxed_(kind == ConeKind::relaxed) {}

    // Precondition: the slopes are valid for the cell.
    float ratio(glm::ivec2 cell) {
        cell_ = cell;
        own_ = pyramid_.cell(cell);
        ratio_ =
            std::min(max_cone_ratio, relaxed_ ? near_relaxed_ratio() : ratio_of(slope_within(1)));
        if (limit_.x >= 0) {
            test_cell(limit_); // the same cell often limits the next one
        }
        test_all_cells();
        return ratio_ * rounding;
    }

private:
    struct Block {
        int level;
        glm::ivec2 at;
    };

    [[nodiscard]] float slope_within(int cells) const {
        const glm::ivec2 at = cell_ - slopes_.begin;
        return slopes_.grids[static_cast<std::size_t>(cells)](at.x, at.y);
    }

    [[nodiscard]] std::optional<Relief> neighbour(int east, int south) const {
        const glm::ivec2 at = cell_ + glm::ivec2(east, south);
        const glm::ivec2 end = pyramid_.cells();
        const bool exists = at.x >= 0 && at.y >= 0 && at.x < end.x && at.y < end.y;
        return exists ? std::optional(pyramid_.cell(at)) : std::nullopt;
    }

    // For ways that end falling in a neighbour. They rise with the slopes of the cell and of the
    // cells between; in the neighbour they follow a parabola that ends falling, so half its initial
    // slope bounds its mean slope.
    [[nodiscard]] float near_relaxed_ratio() const {
        float slope = own_slope();
        for (const Quadrant quadrant : quadrants) {
            const auto east = neighbour(quadrant.east, 0);
            const auto south = neighbour(0, quadrant.south);
            const auto beyond = neighbour(quadrant.east, quadrant.south);
            for (const auto* end : {&east, &south, &beyond}) {
                const auto fan = *end ? falling(**end, quadrant) : std::nullopt;
                if (!fan) {
                    continue;
                }
                slope = std::max({slope, max_slope_in(own_, quadrant, *fan),
                                  0.5F * max_slope_in(**end, quadrant, *fan)});
                if (end == &beyond) {
                    slope = std::max({slope, max_slope_in(*east, quadrant, *fan),
                                      max_slope_in(*south, quadrant, *fan)});
                }
            }
        }
        return ratio_of(std::min(slope, slope_within(1)));
    }

    // Between two points of a patch, falling at the end: half the steepest slope; and, because only
    // the twist bends a patch along a line, at most twist / √2.
    [[nodiscard]] float own_slope() const {
        const float twist = own_.east.high - own_.east.low;
        return std::min(0.5F * max_slope(own_), twist / std::sqrt(2.0F));
    }

    void test_all_cells() {
        stack_.push_back({pyramid_.last_level(), {0, 0}});
        while (!stack_.empty()) {
            const Block block = stack_.back();
            stack_.pop_back();
            if (may_limit(block.level, block.at)) {
                if (block.level == 0) {
                    test_cell(block.at);
                } else {
                    push_parts(block);
                }
            }
        }
    }

    // The nearest part is on top.
    void push_parts(const Block& block) {
        const int level = block.level - 1;
        const glm::ivec2 end = pyramid_.size(level);
        const glm::ivec2 first = 2 * block.at;
        const int near_east = (cell_.x >> level) > first.x ? 1 : 0;
        const int near_south = (cell_.y >> level) > first.y ? 1 : 0;
        for (const glm::ivec2 part :
             {glm::ivec2(1, 1), glm::ivec2(1, 0), glm::ivec2(0, 1), glm::ivec2(0, 0)}) {
            const glm::ivec2 at = first + glm::ivec2(part.x ^ near_east, part.y ^ near_south);
            if (at.x < end.x && at.y < end.y) {
                stack_.push_back({level, at});
            }
        }
    }

    // Bounds of the offset from a point of the cell to a point of a block, samples along one axis.
    static Bounds offset_along(int cell, int first, int cells) {
        return {static_cast<float>(first - cell - 1), static_cast<float>(first + cells - cell)};
    }
    static float gap_to(Bounds offset) { return std::max({offset.low, -offset.high, 0.0F}); }

    [[nodiscard]] bool may_limit(int level, glm::ivec2 at) const {
        const Relief block = pyramid_.block(level, at);
        const float rise = block.height.high - own_.height.low;
        if (!(rise > 0.0F)) {
            return false;
        }
        const glm::ivec2 first = at * (1 << level);
        const Bounds east = offset_along(cell_.x, first.x, 1 << level);
        const Bounds south = offset_along(cell_.y, first.y, 1 << level);
        const float gap_east = gap_to(east);
        const float gap_south = gap_to(south);
        const float limit = ratio_ * rise;
        return gap_east * gap_east + gap_south * gap_south < limit * limit &&
               (!relaxed_ ||
                min_product(block.east, east) + min_product(block.south, south) < 0.0F);
    }

    // Limits the ratio by a cell that is not a neighbour.
    void test_cell(glm::ivec2 at) {
        const glm::ivec2 away = glm::abs(at - cell_);
        const int cells = std::max(away.x, away.y);
        if (cells <= 1 || !may_limit(0, at)) {
            return;
        }
        const float gap = glm::length(glm::vec2(glm::max(away - 1, glm::ivec2(0))));
        const float rise = pyramid_.cell(at).height.high - own_.height.low;
        const float by_slope = cells <= near_cells ? ratio_of(slope_within(cells)) : 0.0F;
        const float found = std::max(gap / rise, by_slope);
        if (found < ratio_) {
            ratio_ = found;
            limit_ = at;
        }
    }

    const ReliefPyramid& pyramid_;
    const SlopeBounds& slopes_;
    bool relaxed_;
    glm::ivec2 cell_{0};
    Relief own_; // of cell_
    float ratio_ = 0.0F;
    glm::ivec2 limit_{-1};
    std::vector<Block> stack_;
};

// The ratio of one cell: the slope bounds need its surroundings only.
float ratio_of_cell(const ReliefPyramid& pyramid, ConeKind kind, glm::ivec2 cell) {
    return ConeFinder(pyramid, slope_bounds(pyramid, kind, cell, cell), kind).ratio(cell);
}

// Rows of cells that share slope bounds: more rows need more memory, fewer more time.
constexpr int rows_at_once = 16;

// The order of the tests changes a ratio by a few roundings.
constexpr float max_difference = 0x1p-20F; // relative

bool is_about(float a, float b) {
    return std::abs(a - b) <= max_difference * std::max(a, b);
}

// A cell of the i-th part of the unit square: the R2 sequence (Roberts 2018) is spread evenly.
glm::ivec2 spread_cell(int i, glm::ivec2 cells) {
    const glm::dvec2 place = glm::fract(
        0.5 + static_cast<double>(i) * glm::dvec2(0.7548776662466927, 0.5698402909980532));
    return glm::min(glm::ivec2(place * glm::dvec2(cells)), cells - 1);
}

} // namespace

std::optional<Grid<float>> cone_map(GridView<const float> heights, ConeKind kind,
                                    const ParallelOptions& parallel) {
    check(heights.cols() >= 2 && heights.rows() >= 2, "cones need at least 2x2 samples");
    const ReliefPyramid pyramid(heights);
    Grid<float> ratios(heights.cols() - 1, heights.rows() - 1);
    const auto find_rows = [&](int first, int last) {
        const SlopeBounds slopes =
            slope_bounds(pyramid, kind, {0, first}, {ratios.cols() - 1, last});
        ConeFinder finder(pyramid, slopes, kind);
        for (int row = first; row <= last && !parallel.stop.stop_requested(); ++row) {
            for (int col = 0; col < ratios.cols(); ++col) {
                ratios(col, row) = finder.ratio({col, row});
            }
        }
    };
    const bool done =
        parallel_for((ratios.rows() + rows_at_once - 1) / rows_at_once,
                     [&](int index) {
                         const int first = index * rows_at_once;
                         find_rows(first, std::min(first + rows_at_once, ratios.rows()) - 1);
                     },
                     parallel);
    // A stop request may have left rows of the last items.
    return done && !parallel.stop.stop_requested() ? std::optional(std::move(ratios))
                                                   : std::nullopt;
}

std::optional<ConeMaps> cone_maps(GridView<const float> heights, const ParallelOptions& parallel) {
    ParallelOptions half = parallel;
    double begin = 0.0;
    if (parallel.progress) {
        half.progress = [&](double fraction) { parallel.progress(begin + 0.5 * fraction); };
    }
    auto plain = cone_map(heights, ConeKind::plain, half);
    begin = 0.5;
    auto relaxed = plain ? cone_map(heights, ConeKind::relaxed, half) : std::nullopt;
    return relaxed ? std::optional(ConeMaps{std::move(*plain), std::move(*relaxed)}) : std::nullopt;
}

bool are_cones_of(const ConeMaps& cones, GridView<const float> heights) {
    constexpr int checked_cells = 256;
    const auto in_range = [](const Grid<float>& ratios) {
        return std::all_of(ratios.samples().begin(), ratios.samples().end(), [](float ratio) {
            return ratio > 0.0F && ratio <= max_cone_ratio; // not NaN
        });
    };
    if (!in_range(cones.plain) || !in_range(cones.relaxed)) {
        return false;
    }
    const ReliefPyramid pyramid(heights);
    for (int i = 0; i < checked_cells; ++i) {
        const glm::ivec2 cell = spread_cell(i, {cones.plain.cols(), cones.plain.rows()});
        const auto is_right = [&](const Grid<float>& ratios, ConeKind kind) {
            return is_about(ratios(cell.x, cell.y), ratio_of_cell(pyramid, kind, cell));
        };
        if (!is_right(cones.plain, ConeKind::plain) ||
            !is_right(cones.relaxed, ConeKind::relaxed)) {
            return false;
        }
    }
    return true;
}

Grid<float> cones_at_samples(const Grid<float>& cells) {
    check(!cells.empty(), "cones of no cells");
    Grid<float> samples(cells.cols() + 1, cells.rows() + 1);
    for (int row = 0; row < samples.rows(); ++row) {
        for (int col = 0; col < samples.cols(); ++col) {
            samples(col, row) =
                std::min({cells.clamped(col - 1, row - 1), cells.clamped(col, row - 1),
                          cells.clamped(col - 1, row), cells.clamped(col, row)});
        }
    }
    return samples;
}

float cone_of_code(float code, float widest, int highest) {
    const float root = code / static_cast<float>(highest);
    return widest * root * root;
}

Grid<std::uint16_t> cone_codes(const Grid<float>& ratios, float widest, int highest) {
    check(widest > 0.0F && highest > 0 && highest <= 65535, "cone codes without a range");
    Grid<std::uint16_t> codes(ratios.cols(), ratios.rows());
    for (std::size_t i = 0; i < codes.size(); ++i) {
        const float ratio = std::clamp(ratios.samples()[i], 0.0F, widest);
        int code = static_cast<int>(std::sqrt(ratio / widest) * static_cast<float>(highest));
        while (code > 0 && cone_of_code(static_cast<float>(code), widest, highest) > ratio) {
            --code;
        }
        codes.samples()[i] = static_cast<std::uint16_t>(code);
    }
    return codes;
}

} // namespace reljef::material
