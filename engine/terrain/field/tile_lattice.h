#pragma once

#include <glm/vec2.hpp>

#include "engine/geo/georeference.h"

namespace reljef::terrain {

/// How a terrain was reduced: each sample of the overview is the middle of reduction × reduction
/// samples of the terrain. Rows that close the terrain at the poles are not reduced.
struct Reduction {
    int factor = 1;
    geo::WrappedRows rows;          ///< of the terrain
    geo::WrappedRows overview_rows; ///< of the overview

    /// The sample of the overview for a sample of the terrain, and back.
    [[nodiscard]] glm::dvec2 on_overview(glm::dvec2 sample) const;
    [[nodiscard]] glm::dvec2 from_overview(glm::dvec2 sample) const;
};

/// Where the samples of a tile lie among those of its terrain. Cells at a pole and the last cells
/// may be shorter; within each cell, latitudes are even.
struct TileLattice {
    glm::dvec2 first{0.0}; ///< sample of the terrain
    glm::dvec2 last{1.0};  ///< sample of the terrain
    double step = 1.0;     ///< samples of the terrain
    glm::ivec2 cells{1};
    geo::WrappedRows rows = {}; ///< of the terrain

    /// The sample where the last cells begin if they are shorter; else beyond the tile.
    [[nodiscard]] glm::ivec2 shorter_from() const {
        const auto along = [&](int axis) {
            const bool is_shorter = first[axis] + step * cells[axis] != last[axis];
            return cells[axis] - (is_shorter ? 1 : 0);
        };
        return {along(0), along(1)};
    }

    /// The sample of the terrain for a sample of the tile, and back. Extrapolates.
    [[nodiscard]] glm::dvec2 on_terrain(glm::dvec2 sample) const;
    [[nodiscard]] glm::dvec2 from_terrain(glm::dvec2 sample) const;

    /// As on_terrain, with the row as WrappedRows::even_row.
    [[nodiscard]] glm::dvec2 on_even_rows(glm::dvec2 sample) const;
    /// Row of the tile's sample as WrappedRows::even_row.
    [[nodiscard]] double even_row(int row) const;

private:
    [[nodiscard]] double on_axis(double sample, int axis) const;
    [[nodiscard]] int cell_at(double row) const;
};

} // namespace reljef::terrain
