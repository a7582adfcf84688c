#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/core/grid.h"

namespace reljef::terrains {

/// The number of a cell that is not there.
inline constexpr std::int32_t no_cell = -1;

inline std::size_t cell_index(std::int32_t cell) {
    return static_cast<std::size_t>(cell);
}

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
    std::span<const float> talus;       ///< steepest stable slope, one per cell
    float spacing = 1.0F;               ///< metres between cells
};

/// Finds the drainage of heights: every cell drains to its steepest neighbour, and a pit along the
/// lowest way to something lower, as if a canyon were cut (Soille et al. 2003). Scratch memory is
/// kept between calls.
class FlowRouter {
public:
    /// Distances between neighbours are disturbed by up to the part `disorder` of them, by `seed`,
    /// as if the cells lay unevenly: against the grid's preferred directions. Precondition: cols,
    /// rows
    /// >= 1, 0 <= disorder < 1.
    FlowRouter(int cols, int rows, std::uint32_t seed, float disorder);

    /// `outlets` is 1 where water leaves. The same result on any number of threads. Precondition:
    /// both hold cols * rows values, the heights all finite, one outlet at least.
    void route(std::span<const float> heights, std::span<const std::uint8_t> outlets,
               unsigned threads);

    /// What the last call of `route` found.
    [[nodiscard]] const Drainage& drainage() const& { return drainage_; }
    [[nodiscard]] Drainage drainage() && { return std::move(drainage_); }

private:
    struct Neighbour {
        int x = 0;
        int y = 0;
        std::int32_t offset = 0; // in cells
        float distance[16] = {}; // as disturbed by each of 16 chances, in cells
        float nearness[16] = {}; // one over it
    };

    [[nodiscard]] bool is_inside(std::int32_t cell, const Neighbour& neighbour) const;
    [[nodiscard]] bool is_lower(std::int32_t cell, std::int32_t than) const;
    void find_steepest(int row);
    void drain_pits();
    void drain(std::int32_t pit);
    void cut(std::int32_t pit, std::int32_t end);
    void accumulate();

    int cols_;
    int rows_;
    std::uint32_t seed_;
    Neighbour neighbours_[8];
    std::span<const float> heights_;
    std::span<const std::uint8_t> outlets_;
    std::vector<std::uint8_t> cut_;       // 1 on the way from a pit
    std::vector<std::int32_t> seen_by_;   // the pit whose search has seen a cell
    std::vector<std::int32_t> came_from_; // in that search
    std::vector<std::uint8_t> donors_;    // that have not been followed yet
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
