#pragma once

#include <array>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/terrain/field/heightfield.h"
#include "engine/terrain/field/placement.h"

namespace reljef::terrain {

/// Cells that are shorter than the others: the last ones of a tile, and those that close a globe at
/// a pole.
class ShorterCells {
public:
    ShorterCells(const Heightfield& heightfield, const Placement& placement);

    /// How far places between `low` and `high` may be from where equal cells would put them, along
    /// columns and rows together, cells.
    [[nodiscard]] double shift_between(glm::ivec2 low, glm::ivec2 high) const;

    /// First and last sample of the equal cells; at least one cell.
    [[nodiscard]] glm::ivec2 first_equal() const { return first_; }
    [[nodiscard]] glm::ivec2 last_equal() const { return last_; }

private:
    // A line of samples where cells of another length begin.
    struct Line {
        int at = 0;
        double missing = 0.0; // of the length of a shorter cell, cells
    };
    void end_with(int axis, double length); // of the last cells
    void add_rows(const TileLattice& tile);

    std::array<std::vector<Line>, 2> lines_; // columns, rows
    glm::ivec2 first_{0};
    glm::ivec2 last_{1};
};

/// Bounds of the derivatives of a placed heightfield: of the map from samples to the ground, where
/// cells are equal. Shorter cells have smaller ones.
struct Bending {
    double stretch = 0.0;   ///< metres between places one sample apart in col and row
    double curvature = 0.0; ///< metres/sample², second derivative in any direction
    double turn = 0.0;      ///< radians/sample, of the vertical
};

Bending bending_of(const Heightfield& heightfield, const Placement& placement,
                   const ShorterCells& shorter);

} // namespace reljef::terrain
