#include "terrains/natural/erosion.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "engine/core/parallel_for.h"
#include "engine/material/noise.h"

namespace reljef::terrains {
namespace {

constexpr float diagonal = 1.41421356F;

/// Largest excess of the drops to the neighbours over the stable drop, which is `stable` metres
/// along columns and rows.
float unstable_height(const Grid<float>& heights, int col, int row, float stable) {
    float excess = 0.0F;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            const float limit = stable * (x != 0 && y != 0 ? diagonal : 1.0F);
            const float drop = heights(col, row) - heights.clamped(col + x, row + y);
            excess = std::max(excess, drop - limit);
        }
    }
    return excess;
}

} // namespace

FlowRouter::FlowRouter(int cols, int rows, std::uint32_t seed, float disorder)
    : cols_(cols), rows_(rows), seed_(seed) {
    constexpr int steps[8][2] = {{1, 0}, {-1, 0}, {0, 1},  {0, -1},
                                 {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
    for (std::size_t i = 0; i < 8; ++i) {
        Neighbour& neighbour = neighbours_[i];
        neighbour.x = steps[i][0];
        neighbour.y = steps[i][1];
        neighbour.offset = neighbour.y * cols + neighbour.x;
        for (std::size_t chance = 0; chance < 16; ++chance) {
            const float stretch = 1.0F + disorder * (static_cast<float>(chance) / 7.5F - 1.0F);
            neighbour.distance[chance] = stretch * (i < 4 ? 1.0F : diagonal);
            neighbour.nearness[chance] = 1.0F / neighbour.distance[chance];
        }
    }
    const std::size_t cells = cell_index(cols) * cell_index(rows);
    cut_.resize(cells);
    seen_by_.resize(cells);
    came_from_.resize(cells);
    donors_.resize(cells);
    drainage_.order.resize(cells);
    drainage_.receiver.resize(cells);
    drainage_.distance.resize(cells);
    drainage_.area.resize(cells);
}

void FlowRouter::route(std::span<const float> heights, std::span<const std::uint8_t> outlets,
                       unsigned threads) {
    heights_ = heights;
    outlets_ = outlets;
    parallel_for(rows_, [&](int row) { find_steepest(row); }, {threads, {}, {}});
    drain_pits();
    accumulate();
}

bool FlowRouter::is_inside(std::int32_t cell, const Neighbour& neighbour) const {
    const int col = cell % cols_ + neighbour.x;
    const int row = cell / cols_ + neighbour.y;
    return col >= 0 && row >= 0 && col < cols_ && row < rows_;
}

// Ties go to the lower number, so that no water runs in a circle.
bool FlowRouter::is_lower(std::int32_t cell, std::int32_t than) const {
    const float height = heights_[cell_index(cell)];
    return height < heights_[cell_index(than)] ||
           (height == heights_[cell_index(than)] && cell < than);
}

void FlowRouter::find_steepest(int row) {
    for (int col = 0; col < cols_; ++col) {
        const std::int32_t cell = row * cols_ + col;
        const bool inner = col > 0 && row > 0 && col < cols_ - 1 && row < rows_ - 1;
        std::uint32_t random_bits = material::hash(seed_, cell, 0);
        float steepest = 0.0F;
        drainage_.receiver[cell_index(cell)] = cell;
        drainage_.distance[cell_index(cell)] = 0.0F;
        for (const Neighbour& neighbour : neighbours_) {
            const std::uint32_t chance = random_bits & 15U;
            random_bits >>= 4U;
            if (!inner && !is_inside(cell, neighbour)) {
                continue;
            }
            const float drop =
                heights_[cell_index(cell)] - heights_[cell_index(cell + neighbour.offset)];
            const float slope = drop * neighbour.nearness[chance];
            if (slope > steepest && outlets_[cell_index(cell)] == 0) {
                steepest = slope;
                drainage_.receiver[cell_index(cell)] = cell + neighbour.offset;
                drainage_.distance[cell_index(cell)] = neighbour.distance[chance];
            }
        }
    }
}

// The lowest pit comes first: a path may end on an earlier path, which ends lower still.
void FlowRouter::drain_pits() {
    std::vector<std::int32_t> pits;
    for (std::int32_t cell = 0; cell < cols_ * rows_; ++cell) {
        if (drainage_.receiver[cell_index(cell)] == cell && outlets_[cell_index(cell)] == 0) {
            pits.push_back(cell);
        }
    }
    std::sort(pits.begin(), pits.end(),
              [&](std::int32_t one, std::int32_t other) { return is_lower(one, other); });
    cut_.assign(cut_.size(), 0);
    seen_by_.assign(seen_by_.size(), no_cell);
    for (const std::int32_t pit : pits) {
        drain(pit);
    }
}

void FlowRouter::drain(std::int32_t pit) {
    const auto is_higher = [&](std::int32_t one, std::int32_t other) {
        return is_lower(other, one);
    };
    std::priority_queue<std::int32_t, std::vector<std::int32_t>, decltype(is_higher)> shore(
        is_higher);
    seen_by_[cell_index(pit)] = pit;
    shore.push(pit);
    while (!shore.empty()) {
        const std::int32_t cell = shore.top();
        shore.pop();
        if (is_lower(cell, pit) || cut_[cell_index(cell)] != 0 || outlets_[cell_index(cell)] != 0) {
            cut(pit, cell);
            return;
        }
        for (const Neighbour& neighbour : neighbours_) {
            const std::int32_t other = cell + neighbour.offset;
            if (is_inside(cell, neighbour) && seen_by_[cell_index(other)] != pit) {
                seen_by_[cell_index(other)] = pit;
                came_from_[cell_index(other)] = cell;
                shore.push(other);
            }
        }
    }
}

/// Makes the cells of a search path drain along it.
void FlowRouter::cut(std::int32_t pit, std::int32_t end) {
    for (std::int32_t cell = end; cell != pit;) {
        const std::int32_t before = came_from_[cell_index(cell)];
        const bool is_straight = cell % cols_ == before % cols_ || cell / cols_ == before / cols_;
        drainage_.receiver[cell_index(before)] = cell;
        drainage_.distance[cell_index(before)] = is_straight ? 1.0F : diagonal;
        cut_[cell_index(before)] = 1;
        cell = before;
    }
}

// Follows every stream from its springs to the first cell that waits for another donor.
void FlowRouter::accumulate() {
    donors_.assign(donors_.size(), 0);
    drainage_.area.assign(drainage_.area.size(), 1.0F);
    for (std::size_t cell = 0; cell < donors_.size(); ++cell) {
        const std::size_t receiver = cell_index(drainage_.receiver[cell]);
        if (receiver != cell) {
            ++donors_[receiver];
        }
    }
    const std::vector<std::uint8_t> springs = donors_;
    std::size_t place = drainage_.order.size();
    for (std::size_t spring = 0; spring < springs.size(); ++spring) {
        for (std::size_t cell = spring; springs[spring] == 0;) {
            const std::size_t receiver = cell_index(drainage_.receiver[cell]);
            drainage_.order[--place] = static_cast<std::int32_t>(cell);
            if (receiver == cell) {
                break;
            }
            drainage_.area[receiver] += drainage_.area[cell];
            if (--donors_[receiver] != 0) {
                break;
            }
            cell = receiver;
        }
    }
}

void erode(std::span<float> heights, const Drainage& drainage, const ErosionStep& step) {
    constexpr float min_slope = 0.0005F;
    for (const std::int32_t index : drainage.order) {
        const std::size_t cell = cell_index(index);
        const std::int32_t receiver = drainage.receiver[cell];
        if (receiver == index) {
            continue;
        }
        const float distance = step.spacing * drainage.distance[cell];
        const float below = heights[cell_index(receiver)];
        const float lifted = heights[cell] + step.uplift[cell];
        const float power =
            step.erodibility[cell] * std::sqrt(drainage.area[cell]) / drainage.distance[cell];
        const float eroded = (lifted + power * below) / (1.0F + power);
        heights[cell] =
            std::clamp(eroded, below + min_slope * distance, below + step.talus[cell] * distance);
    }
}

void slide(Grid<float>& heights, std::span<const float> talus, float spacing, int passes,
           unsigned threads) {
    Grid<float> before;
    const std::size_t cols = cell_index(heights.cols());
    for (int pass = 0; pass < passes; ++pass) {
        before = heights;
        for_each_cell(heights.cols(), heights.rows(), {threads, {}, {}}, [&](int col, int row) {
            const float stable = spacing * talus[cell_index(row) * cols + cell_index(col)];
            heights(col, row) -= 0.5F * unstable_height(before, col, row, stable);
        });
    }
}

} // namespace reljef::terrains
