#include "engine/terrain/field/tile_lattice.h"

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

glm::dvec2 TileLattice::on_terrain(glm::dvec2 sample) const {
    const auto along = [&](int axis) {
        const double last_cell = cells[axis] - 1.0;
        const double start = first[axis] + step * last_cell; // of the last cell
        const double beyond = sample[axis] - last_cell;
        return beyond <= 0.0 ? first[axis] + step * sample[axis]
                             : start + beyond * (last[axis] - start);
    };
    return {along(0), along(1)};
}

glm::dvec2 TileLattice::from_terrain(glm::dvec2 sample) const {
    const auto along = [&](int axis) {
        const double last_cell = cells[axis] - 1.0;
        const double start = first[axis] + step * last_cell;
        const double beyond = sample[axis] - start;
        return beyond <= 0.0 ? (sample[axis] - first[axis]) / step
                             : last_cell + beyond / (last[axis] - start);
    };
    return {along(0), along(1)};
}

} // namespace reljef::terrain
