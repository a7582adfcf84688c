#include "engine/terrain/field/tile_lattice.h"

#include <algorithm>
#include <cmath>

namespace reljef::terrain {

glm::dvec2 Reduction::on_overview(glm::dvec2 sample) const {
    sample.y = rows.source_row(sample.y);
    const glm::dvec2 at = (sample - 0.5 * (factor - 1)) / static_cast<double>(factor);
    return {at.x, overview_rows.closed_row(at.y)};
}

glm::dvec2 Reduction::from_overview(glm::dvec2 sample) const {
    sample.y = overview_rows.source_row(sample.y);
    const glm::dvec2 at = sample * static_cast<double>(factor) + 0.5 * (factor - 1);
    return {at.x, rows.closed_row(at.y)};
}

double TileLattice::on_axis(double sample, int axis) const {
    const double last_cell = cells[axis] - 1.0;
    const double start = first[axis] + step * last_cell; // of the last cell
    const double beyond = sample - last_cell;
    return beyond <= 0.0 ? first[axis] + step * sample : start + beyond * (last[axis] - start);
}

glm::dvec2 TileLattice::on_terrain(glm::dvec2 sample) const {
    const glm::dvec2 even = on_even_rows(sample);
    return {even.x, rows.wrap().rows() > 0 ? rows.from_even_row(even.y) : even.y};
}

glm::dvec2 TileLattice::from_terrain(glm::dvec2 sample) const {
    const auto along = [&](int axis) {
        const double last_cell = cells[axis] - 1.0;
        const double start = first[axis] + step * last_cell;
        const double beyond = sample[axis] - start;
        return beyond <= 0.0 ? (sample[axis] - first[axis]) / step
                             : last_cell + beyond / (last[axis] - start);
    };
    if (rows.wrap().rows() == 0) {
        return {along(0), along(1)};
    }
    const int cell = cell_at((sample.y - first.y) / step);
    const double start = even_row(cell);
    return {along(0), cell + (rows.even_row(sample.y) - start) / (even_row(cell + 1) - start)};
}

glm::dvec2 TileLattice::on_even_rows(glm::dvec2 sample) const {
    if (rows.wrap().rows() == 0) {
        return {on_axis(sample.x, 0), on_axis(sample.y, 1)};
    }
    const int cell = cell_at(sample.y);
    const double start = even_row(cell);
    return {on_axis(sample.x, 0), start + (sample.y - cell) * (even_row(cell + 1) - start)};
}

double TileLattice::even_row(int row) const {
    return rows.even_row(std::min(first.y + step * row, last.y));
}

int TileLattice::cell_at(double row) const {
    return std::clamp(static_cast<int>(std::floor(row)), 0, cells.y - 1);
}

} // namespace reljef::terrain
