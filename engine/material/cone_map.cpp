#include "engine/material/cone_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

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

// Of a block of cells: its heights, and its slopes along the columns and along the rows, a sample.
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

Grid<Relief> coarser(const Grid<Relief>& fine) {
    Grid<Relief> coarse((fine.cols() + 1) / 2, (fine.rows() + 1) / 2);
    for (int row = 0; row < coarse.rows(); ++row) {
        for (int col = 0; col < coarse.cols(); ++col) {
            const int c = 2 * col;
            const int r = 2 * row;
            coarse(col, row) = joined(joined(fine.clamped(c, r), fine.clamped(c + 1, r)),
                                      joined(fine.clamped(c, r + 1), fine.clamped(c + 1, r + 1)));
        }
    }
    return coarse;
}

std::vector<Grid<Relief>> relief_pyramid(GridView<const float> heights) {
    std::vector<Grid<Relief>> levels;
    Grid<Relief> cells(heights.cols() - 1, heights.rows() - 1);
    for (int row = 0; row < cells.rows(); ++row) {
        for (int col = 0; col < cells.cols(); ++col) {
            cells(col, row) = relief_of_cell(heights, col, row);
        }
    }
    levels.push_back(std::move(cells));
    while (levels.back().size() > 1) {
        levels.push_back(coarser(levels.back()));
    }
    return levels;
}

float steepest_slope(const Relief& relief) {
    const float east = std::max(-relief.east.low, relief.east.high);
    const float south = std::max(-relief.south.low, relief.south.high);
    return std::hypot(east, south);
}

// How far two gradients may lie apart.
float variation(const Relief& relief) {
    return std::hypot(relief.east.high - relief.east.low, relief.south.high - relief.south.low);
}

// Of each 3×3.
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

// The way from the tip to a point that limits its cone rises at most so steeply on the whole, where
// both lie in this block: as its steepest slope; and, where the surface falls at the way's end, as
// much as the gradients on the way differ from that at its end.
float steepest_way(const Relief& block, ConeKind kind) {
    const float steepest = steepest_slope(block);
    return kind == ConeKind::plain ? steepest : std::min(steepest, variation(block));
}

// Up to so many cells away this bounds a rise better than the cells' lowest and highest heights
// may: both cells' own extents count for much of their distance there.
constexpr int near_cells = 8;

// [n]: of ways among the cells up to n away; fewer where it was stopped.
std::vector<Grid<float>> steepest_ways(const Grid<Relief>& cells, ConeKind kind,
                                       const std::stop_token& stop) {
    std::vector<Grid<float>> ways;
    Grid<Relief> blocks = cells;
    for (int n = 0; n <= near_cells && !stop.stop_requested(); ++n) {
        Grid<float> steepest(cells.cols(), cells.rows());
        for (std::size_t i = 0; i < cells.size(); ++i) {
            steepest.samples()[i] = steepest_way(blocks.samples()[i], kind);
        }
        ways.push_back(std::move(steepest));
        blocks = widened(blocks);
    }
    return ways;
}

float min_product(Bounds a, Bounds b) {
    return std::min({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
}

// A quarter of all directions, mirrored so that both parts of each are >= 0.
struct Quarter {
    int east;
    int south;
};
constexpr std::array<Quarter, 4> quarters{{{1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};

Bounds mirrored(Bounds bounds, int sign) {
    return sign > 0 ? bounds : Bounds{-bounds.high, -bounds.low};
}

// Directions between two unit vectors of the quarter, counted from east (1, 0) to south (0, 1).
struct Fan {
    glm::vec2 from{0.0F};
    glm::vec2 to{0.0F};
};

// In which directions of the quarter a cell may fall.
std::optional<Fan> falling(const Relief& cell, Quarter quarter) {
    const float east = mirrored(cell.east, quarter.east).low;
    const float south = mirrored(cell.south, quarter.south).low;
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

// The steepest that a cell may rise in a direction of the fan.
float steepest_in(const Relief& cell, Quarter quarter, const Fan& fan) {
    const glm::vec2 slope(mirrored(cell.east, quarter.east).high,
                          mirrored(cell.south, quarter.south).high);
    const bool inside = cross(fan.from, slope) >= 0.0F && cross(slope, fan.to) >= 0.0F;
    return inside ? glm::length(slope)
                  : std::max(glm::dot(slope, fan.from), glm::dot(slope, fan.to));
}

// What a float sum of a few products may be off by, and the ratio is made smaller by.
constexpr float rounding = 1.0F - 0x1p-20F;

// Finds the ratio of one cell after another.
class ConeFinder {
public:
    ConeFinder(const std::vector<Grid<Relief>>& levels, const std::vector<Grid<float>>& steepest,
               ConeKind kind, float widest)
        : levels_(levels), cells_(levels.front()), steepest_(steepest),
          relaxed_(kind == ConeKind::relaxed), widest_(widest) {}

    float ratio(glm::ivec2 cell) {
        cell_ = cell;
        ratio_ = std::min(widest_, relaxed_ ? near_relaxed_ratio() : 1.0F / slope_within(1));
        if (limit_.x >= 0) {
            look_at(limit_); // what limits a cell often limits the next
        }
        look_everywhere();
        return ratio_ * rounding;
    }

private:
    struct Block {
        int level;
        glm::ivec2 at;
    };

    [[nodiscard]] float slope_within(int cells) const {
        return steepest_[static_cast<std::size_t>(cells)](cell_.x, cell_.y);
    }

    [[nodiscard]] const Relief* neighbour(int east, int south) const {
        const glm::ivec2 at = cell_ + glm::ivec2(east, south);
        const bool there = at.x >= 0 && at.y >= 0 && at.x < cells_.cols() && at.y < cells_.rows();
        return there ? &cells_(at.x, at.y) : nullptr;
    }

    // Where the way from the cell ends falling in a neighbour: it rises in the cell and in what
    // lies between as these do, and in the neighbour, along a parabola that ends falling, half as
    // steeply as that begins.
    [[nodiscard]] float near_relaxed_ratio() const {
        float slope = own_slope();
        for (const Quarter quarter : quarters) {
            const Relief* east = neighbour(quarter.east, 0);
            const Relief* south = neighbour(0, quarter.south);
            const Relief* beyond = neighbour(quarter.east, quarter.south);
            for (const Relief* end : {east, south, beyond}) {
                const auto fan = end == nullptr ? std::nullopt : falling(*end, quarter);
                if (!fan) {
                    continue;
                }
                slope = std::max({slope, steepest_in(cells_(cell_.x, cell_.y), quarter, *fan),
                                  0.5F * steepest_in(*end, quarter, *fan)});
                if (end == beyond) {
                    slope = std::max({slope, steepest_in(*east, quarter, *fan),
                                      steepest_in(*south, quarter, *fan)});
                }
            }
        }
        return 1.0F / std::min(slope, slope_within(1));
    }

    // From one point of a patch to another where it falls: half as steep as the steepest, and, as a
    // patch bends along a line by its twist only, no steeper than the twist over √2.
    [[nodiscard]] float own_slope() const {
        const Relief& own = cells_(cell_.x, cell_.y);
        const float twist = own.east.high - own.east.low;
        return std::min(0.5F * steepest_slope(own), twist / std::sqrt(2.0F));
    }

    void look_everywhere() {
        stack_.push_back({static_cast<int>(levels_.size()) - 1, {0, 0}});
        while (!stack_.empty()) {
            const Block block = stack_.back();
            stack_.pop_back();
            if (may_limit(block.level, block.at)) {
                if (block.level == 0) {
                    look_at(block.at);
                } else {
                    push_parts(block);
                }
            }
        }
    }

    // The nearest part is looked at first.
    void push_parts(const Block& block) {
        const int level = block.level - 1;
        const Grid<Relief>& grid = levels_[static_cast<std::size_t>(level)];
        const glm::ivec2 first = 2 * block.at;
        const int near_east = (cell_.x >> level) > first.x ? 1 : 0;
        const int near_south = (cell_.y >> level) > first.y ? 1 : 0;
        for (const glm::ivec2 part :
             {glm::ivec2(1, 1), glm::ivec2(1, 0), glm::ivec2(0, 1), glm::ivec2(0, 0)}) {
            const glm::ivec2 at = first + glm::ivec2(part.x ^ near_east, part.y ^ near_south);
            if (at.x < grid.cols() && at.y < grid.rows()) {
                stack_.push_back({level, at});
            }
        }
    }

    // Samples between the cell and a block along one axis, and from any of its points to any of the
    // block's.
    static Bounds way_along(int cell, int first, int cells) {
        return {static_cast<float>(first - cell - 1), static_cast<float>(first + cells - cell)};
    }
    static float gap_of(Bounds way) { return std::max({way.low, -way.high, 0.0F}); }

    [[nodiscard]] bool may_limit(int level, glm::ivec2 at) const {
        const Relief& block = levels_[static_cast<std::size_t>(level)](at.x, at.y);
        const float rise = block.height.high - cells_(cell_.x, cell_.y).height.low;
        if (!(rise > 0.0F)) {
            return false;
        }
        const glm::ivec2 first = at * (1 << level);
        const Bounds east = way_along(cell_.x, first.x, 1 << level);
        const Bounds south = way_along(cell_.y, first.y, 1 << level);
        const float gap_east = gap_of(east);
        const float gap_south = gap_of(south);
        const float limit = ratio_ * rise;
        return gap_east * gap_east + gap_south * gap_south < limit * limit &&
               (!relaxed_ ||
                min_product(block.east, east) + min_product(block.south, south) < 0.0F);
    }

    // Takes what a cell that is no neighbour limits the ratio to.
    void look_at(glm::ivec2 at) {
        const glm::ivec2 away = glm::abs(at - cell_);
        const int cells = std::max(away.x, away.y);
        if (cells <= 1 || !may_limit(0, at)) {
            return;
        }
        const float gap = glm::length(glm::vec2(glm::max(away - 1, glm::ivec2(0))));
        const float rise = cells_(at.x, at.y).height.high - cells_(cell_.x, cell_.y).height.low;
        const float by_slope = cells <= near_cells ? 1.0F / slope_within(cells) : 0.0F;
        const float found = std::max(gap / rise, by_slope);
        if (found < ratio_) {
            ratio_ = found;
            limit_ = at;
        }
    }

    const std::vector<Grid<Relief>>& levels_;
    const Grid<Relief>& cells_;
    const std::vector<Grid<float>>& steepest_;
    bool relaxed_;
    float widest_;
    glm::ivec2 cell_{0};
    float ratio_ = 0.0F;
    glm::ivec2 limit_{-1};
    std::vector<Block> stack_;
};

} // namespace

std::optional<Grid<float>> cone_map(GridView<const float> heights, ConeKind kind,
                                    const ConeOptions& options) {
    check(heights.cols() >= 2 && heights.rows() >= 2, "cones need at least 2x2 samples");
    const std::vector<Grid<Relief>> levels = relief_pyramid(heights);
    const std::vector<Grid<float>> steepest =
        steepest_ways(levels.front(), kind, options.parallel.stop);
    Grid<float> ratios(heights.cols() - 1, heights.rows() - 1);
    const bool done = parallel_for(
        ratios.rows(),
        [&](int row) {
            ConeFinder finder(levels, steepest, kind, options.widest);
            for (int col = 0; col < ratios.cols(); ++col) {
                ratios(col, row) = finder.ratio({col, row});
            }
        },
        options.parallel);
    return done ? std::optional(std::move(ratios)) : std::nullopt;
}

std::optional<ConeMaps> cone_maps(GridView<const float> heights, const ConeOptions& options) {
    ConeOptions half = options;
    double begin = 0.0;
    if (options.parallel.progress) {
        half.parallel.progress = [&](double fraction) {
            options.parallel.progress(begin + 0.5 * fraction);
        };
    }
    auto plain = cone_map(heights, ConeKind::plain, half);
    begin = 0.5;
    auto relaxed = plain ? cone_map(heights, ConeKind::relaxed, half) : std::nullopt;
    return relaxed ? std::optional(ConeMaps{std::move(*plain), std::move(*relaxed)}) : std::nullopt;
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
