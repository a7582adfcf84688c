#include "terrains/erosion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/worker_pool.h"
#include "terrains/noise.h"

namespace reljef::terrains {
namespace {

constexpr float diagonal = 1.41421356F;
constexpr std::size_t height_classes = 1U << 15U;

// Values of Node::next besides the number of the next cell.
constexpr std::int32_t nobody = -1;
constexpr std::int32_t unseen = -2;
constexpr std::int32_t done = -3;
constexpr std::int32_t wall = -4;

std::size_t at(std::int32_t cell) {
    return static_cast<std::size_t>(cell);
}

} // namespace

FlowRouter::FlowRouter(int cols, int rows, std::uint32_t seed, float disorder)
    : cols_(cols), rows_(rows), stride_(cols + 2),
      seed_(seed), neighbours_{{1, 1.0F},
                               {-1, 1.0F},
                               {stride_, 1.0F},
                               {-stride_, 1.0F},
                               {stride_ + 1, diagonal},
                               {stride_ - 1, diagonal},
                               {-stride_ + 1, diagonal},
                               {-stride_ - 1, diagonal}},
      nodes_(at(stride_) * at(rows + 2), Node{0.0F, wall}), first_(height_classes) {
    for (int i = 0; i < 16; ++i) {
        disturbance_[i] = 1.0F + disorder * (static_cast<float>(i) / 7.5F - 1.0F);
    }
    const std::size_t cells = at(cols) * at(rows);
    drainage_.order.reserve(cells);
    drainage_.receiver.assign(cells, 0);
    drainage_.distance.assign(cells, 0.0F);
    drainage_.area.assign(cells, 1.0F);
}

void FlowRouter::route(std::span<const float> heights, std::span<const std::uint8_t> outlets) {
    prepare(heights, outlets);
    for (; current_ < first_.size(); ++current_) {
        while (first_[current_] != nobody) {
            const std::int32_t cell = first_[current_];
            first_[current_] = nodes_[at(cell)].next;
            visit(cell);
        }
    }
    accumulate();
}

void FlowRouter::prepare(std::span<const float> heights, std::span<const std::uint8_t> outlets) {
    const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
    lowest_ = *low;
    classes_per_metre_ = static_cast<float>(height_classes - 1) / std::max(*high - *low, 1.0F);
    current_ = 0;
    outlets_ = outlets;
    std::fill(first_.begin(), first_.end(), nobody);
    drainage_.order.clear();
    for (std::int32_t row = 0; row < rows_; ++row) {
        const std::size_t from = at(row) * at(cols_);
        const std::size_t to = at(row + 1) * at(stride_) + 1;
        for (std::size_t col = 0; col < at(cols_); ++col) {
            nodes_[to + col] = {heights[from + col], unseen};
            if (outlets[from + col] != 0) {
                push(static_cast<std::int32_t>(to + col), heights[from + col]);
            }
        }
    }
}

void FlowRouter::push(std::int32_t cell, float level) {
    const auto wanted = static_cast<std::size_t>((level - lowest_) * classes_per_metre_);
    const std::size_t queue = std::clamp(wanted, current_, first_.size() - 1);
    nodes_[at(cell)] = {level, first_[queue]};
    first_[queue] = cell;
}

void FlowRouter::visit(std::int32_t cell) {
    constexpr float rise_under_water = 1.0e-3F; // keeps the flow going through a depression
    const float height = nodes_[at(cell)].height;
    const std::int32_t index = unpadded(cell);
    std::uint32_t luck = hash(seed_, index, 0);
    std::int32_t receiver = cell;
    float receiver_distance = 0.0F;
    float steepest = std::numeric_limits<float>::lowest();
    for (const Neighbour& neighbour : neighbours_) {
        const std::int32_t other = cell + neighbour.step;
        const Node node = nodes_[at(other)];
        if (node.next == unseen) {
            push(other, std::max(node.height, height + rise_under_water));
        } else if (node.next == done) {
            const float distance = neighbour.distance * disturbance_[luck & 15U];
            const float drop = height - node.height;
            if (drop > steepest * distance) {
                steepest = drop / distance;
                receiver = other;
                receiver_distance = distance;
            }
        }
        luck >>= 4U;
    }
    const bool leaves = outlets_[at(index)] != 0;
    drainage_.receiver[at(index)] = leaves ? index : unpadded(receiver);
    drainage_.distance[at(index)] = leaves ? 0.0F : receiver_distance;
    drainage_.order.push_back(index);
    nodes_[at(cell)].next = done;
}

void FlowRouter::accumulate() {
    std::fill(drainage_.area.begin(), drainage_.area.end(), 1.0F);
    for (std::size_t i = drainage_.order.size(); i-- > 0;) {
        const std::int32_t cell = drainage_.order[i];
        const std::int32_t receiver = drainage_.receiver[at(cell)];
        if (receiver != cell) {
            drainage_.area[at(receiver)] += drainage_.area[at(cell)];
        }
    }
}

std::int32_t FlowRouter::unpadded(std::int32_t cell) const {
    return (cell / stride_ - 1) * cols_ + cell % stride_ - 1;
}

void erode(std::span<float> heights, const Drainage& drainage, const ErosionStep& step) {
    constexpr float least_slope = 0.0005F;
    for (const std::int32_t index : drainage.order) {
        const std::size_t cell = at(index);
        const std::int32_t receiver = drainage.receiver[cell];
        if (receiver == index) {
            continue;
        }
        const float distance = step.spacing * drainage.distance[cell];
        const float below = heights[at(receiver)];
        const float lifted = heights[cell] + step.uplift[cell];
        const float power =
            step.erodibility[cell] * std::sqrt(drainage.area[cell]) / drainage.distance[cell];
        const float eroded = (lifted + power * below) / (1.0F + power);
        heights[cell] =
            std::clamp(eroded, below + least_slope * distance, below + step.talus[cell] * distance);
    }
}

void slide(Grid<float>& heights, std::span<const float> talus, float spacing, int passes,
           unsigned threads) {
    Grid<float> before;
    const int cols = heights.cols();
    for (int pass = 0; pass < passes; ++pass) {
        before = heights;
        const auto slide_row = [&](int row) {
            for (int col = 0; col < cols; ++col) {
                float excess = 0.0F;
                const float height = before(col, row);
                const float stable = spacing * talus[at(row) * at(cols) + at(col)];
                for (int y = -1; y <= 1; ++y) {
                    for (int x = -1; x <= 1; ++x) {
                        const float reach = stable * (x != 0 && y != 0 ? diagonal : 1.0F);
                        const float drop = height - before.clamped(col + x, row + y);
                        excess = std::max(excess, drop - reach);
                    }
                }
                heights(col, row) = height - 0.5F * excess;
            }
        };
        parallel_for(heights.rows(), slide_row, {.threads = threads, .stop = {}, .progress = {}});
    }
}

} // namespace reljef::terrains
