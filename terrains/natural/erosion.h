#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/core/grid.h"

namespace reljef::terrains {

inline constexpr std::int32_t no_cell = -1;

inline std::size_t cell_index(std::int32_t cell) {
    return static_cast<std::size_t>(cell);
}

/// The drainage network of a grid. Cell (col, row) has the number row * cols + col.
struct Drainage {
    std::vector<std::int32_t> order;    ///< every cell once, each after its receiver
    std::vector<std::int32_t> receiver; ///< the neighbour a cell drains to; an outlet: itself
    std::vector<float> distance;        ///< to the receiver, in cells; an outlet: 0
    std::vector<float> area;            ///< cells that drain through a cell, itself included
};

/// Parameters of erode(), one value per cell.
struct ErosionStep {
    std::span<const float> uplift;      ///< metres
    std::span<const float> erodibility; ///< metres that one metre of slope loses at a catchment of
                                        ///< 1 m², per metre of the cell's size
    std::span<const float> talus;       ///< steepest stable slope
    float spacing = 1.0F;               ///< metres between cells
};

/// Computes drainage. Every cell drains to its steepest neighbour. A pit drains along the lowest
/// path to a lower cell, as if a canyon were cut (Soille et al. 2003).
class FlowRouter {
public:
    /// The distances between neighbours vary by up to `disorder` of their length, by `seed`: this
    /// hides the grid's preferred directions. Preconditions: cols, rows >= 1, 0 <= disorder < 1.
    FlowRouter(int cols, int rows, std::uint32_t seed, float disorder);

    /// `outlets` is 1 where water leaves. The result does not depend on the number of threads.
    /// Preconditions: cols * rows finite heights, as many outlet flags, at least one outlet.
    void route(std::span<const float> heights, std::span<const std::uint8_t> outlets,
               unsigned threads);

    /// The result of the last route().
    [[nodiscard]] const Drainage& drainage() const& { return drainage_; }
    [[nodiscard]] Drainage drainage() && { return std::move(drainage_); }

private:
    struct Neighbour {
        int x = 0;
        int y = 0;
        std::int32_t offset = 0; // in cells
        float distance[16] = {}; // in cells, one for each of 16 random numbers
        float nearness[16] = {}; // 1 / distance
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
    std::vector<std::uint8_t> cut_;       // 1 on the path from a pit
    std::vector<std::int32_t> seen_by_;   // the pit whose search reached a cell last
    std::vector<std::int32_t> came_from_; // in that search
    std::vector<std::uint8_t> donors_;    // number of donors that are not processed
    Drainage drainage_;
};

/// One implicit step of uplift and stream power erosion, dh/dt = U - K A^½ S, from the outlets
/// upwards (Braun & Willett 2013). Afterwards the slope from each cell to its receiver lies between
/// 0 and `talus`. Outlets keep their height.
void erode(std::span<float> heights, const Drainage& drainage, const ErosionStep& step);

/// Lowers slopes above `talus`: in each pass a cell loses half of its excess over its neighbours.
/// The result does not depend on the number of threads.
void slide(Grid<float>& heights, std::span<const float> talus, float spacing, int passes,
           unsigned threads);

} // namespace reljef::terrains
