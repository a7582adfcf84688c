#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/core/grid.h"

namespace reljef::terrains {

/// Where the water of every cell goes. Cells are numbered row * cols + col.
struct Drainage {
    std::vector<std::int32_t> order;    ///< every cell once, each after its receiver
    std::vector<std::int32_t> receiver; ///< the neighbour a cell drains to; an outlet: itself
    std::vector<float> distance;        ///< to the receiver, in cells; an outlet: 0
    std::vector<float> area;            ///< cells that drain through a cell, itself included
};

/// What the rock and the climate do in one step of `erode`.
struct ErosionStep {
    std::span<const float> uplift;      ///< metres, one per cell
    std::span<const float> erodibility; ///< one per cell: the metres that one metre of slope loses
                                        ///< at a catchment of 1 m², per metre of the cell's size
    std::span<const float> talus; ///< steepest stable slope, one per cell
    float spacing = 1.0F;         ///< metres between cells
};

/// Finds the drainage of heights by flooding them from the outlets in order of height (Barnes et
/// al. 2014, with a queue of height classes): a depression drains over its lowest rim. Scratch
/// memory is kept between calls.
class FlowRouter {
public:
    /// Distances between neighbours are disturbed by up to the part `disorder` of them, by `seed`,
    /// as if the cells lay unevenly: against the grid's preferred directions. Precondition: cols,
    /// rows
    /// >= 1, 0 <= disorder < 1.
    FlowRouter(int cols, int rows, std::uint32_t seed, float disorder);

    /// `outlets` is 1 where water leaves. Precondition: both hold cols * rows values, the heights
    /// all finite, one outlet at least.
    void route(std::span<const float> heights, std::span<const std::uint8_t> outlets);

    /// What the last call of `route` found.
    [[nodiscard]] const Drainage& drainage() const& { return drainage_; }
    [[nodiscard]] Drainage drainage() && { return std::move(drainage_); }

private:
    struct Node {
        float height = 0.0F;   // once queued: of the water that stands over the cell
        std::int32_t next = 0; // in its class of height; or one of the states below
    };
    struct Neighbour {
        std::int32_t step = 0; // in padded cells
        float distance = 1.0F;
    };

    void prepare(std::span<const float> heights, std::span<const std::uint8_t> outlets);
    void push(std::int32_t cell, float level);
    void visit(std::int32_t cell);
    void accumulate();
    [[nodiscard]] std::int32_t unpadded(std::int32_t cell) const;

    int cols_;
    int rows_;
    int stride_; // of the padded arrays: a wall of one cell around
    std::uint32_t seed_;
    float disturbance_[16];
    Neighbour neighbours_[8];
    std::vector<Node> nodes_;
    std::vector<std::int32_t> first_; // of every class of height
    std::span<const std::uint8_t> outlets_;
    float lowest_ = 0.0F;
    float classes_per_metre_ = 1.0F;
    std::size_t current_ = 0;
    Drainage drainage_;
};

/// One implicit step of uplift and stream power erosion, dh/dt = U - K A^½ S, from the outlets
/// upwards (Braun & Willett 2013), after which no cell stands steeper over its receiver than
/// `talus` nor lies below it. Outlets keep their height.
void erode(std::span<float> heights, const Drainage& drainage, const ErosionStep& step);

/// Lets slopes above `talus` slide: `passes` times, every cell gives a part of the excess to its
/// lowest neighbour's height. The same bits on any number of threads.
void slide(Grid<float>& heights, std::span<const float> talus, float spacing, int passes,
           unsigned threads);

} // namespace reljef::terrains
