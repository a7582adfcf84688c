#include "engine/terrain/mesh/bending.h"

#include <algorithm>
#include <cstddef>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace reljef::terrain {
namespace {

// Derivatives are differences on a lattice of 16×16 cells. The margins cover the points between.
constexpr int lattice = 16;
constexpr double first_margin = 1.0 + 0x1p-4;
constexpr double second_margin = 2.0;

struct Derivatives {
    double first = 0.0;
    double second = 0.0;
    double turn = 0.0;

    void add(const Derivatives& other) {
        first = std::max(first, other.first);
        second = std::max(second, other.second);
        turn = std::max(turn, other.turn);
    }
};

Derivatives derivatives_at(const Placement& placement, glm::dvec2 from, glm::dvec2 step,
                           double height) {
    const auto at = [&](double i, double j) {
        return placement.world_from_sample({from.x + i * step.x, from.y + j * step.y, height});
    };
    const glm::dvec3 here = at(0, 0);
    const glm::dvec3 east = at(1, 0);
    const glm::dvec3 south = at(0, 1);
    const glm::dvec3 up = placement.up(here);
    Derivatives found;
    found.first = glm::distance(here, east) / step.x + glm::distance(here, south) / step.y;
    found.second = glm::length(here - 2.0 * east + at(2, 0)) / (step.x * step.x) +
                   glm::length(here - 2.0 * south + at(0, 2)) / (step.y * step.y) +
                   glm::length(here - east - south + at(1, 1)) / (step.x * step.y);
    found.turn = glm::distance(up, placement.up(east)) / step.x +
                 glm::distance(up, placement.up(south)) / step.y;
    return found;
}

} // namespace

ShorterCells::ShorterCells(const Heightfield& heightfield, const Placement& placement)
    : last_(heightfield.heights.cols() - 1, heightfield.heights.rows() - 1) {
    if (const TileLattice* const tile = placement.lattice()) {
        const double length = (tile->last.x - tile->first.x) / tile->step;
        end_with(0, length - (tile->cells.x - 1));
        add_rows(*tile);
    } else if (heightfield.georeference) {
        const geo::GlobalWrap& wrap = heightfield.georeference->geodetic.rows().wrap();
        if (wrap.north > 0.0 && wrap.north < 1.0) {
            lines_[1].push_back({1, 1.0 - wrap.north});
            first_.y = 1;
        }
        if (wrap.south > 0.0) {
            end_with(1, wrap.south);
        }
    }
    last_ = glm::max(last_, first_ + 1);
}

void ShorterCells::end_with(int axis, double length) {
    if (length < 1.0) {
        --last_[axis];
        lines_[static_cast<std::size_t>(axis)].push_back({last_[axis], 1.0 - length});
    }
}

// Rows between samples of the terrain are shorter at a pole, too.
void ShorterCells::add_rows(const TileLattice& tile) {
    const auto length = [&](int cell) {
        return (tile.even_row(cell + 1) - tile.even_row(cell)) / tile.step;
    };
    double missing = 0.0;
    for (; first_.y < last_.y && length(first_.y) < 1.0; ++first_.y) {
        missing += 1.0 - length(first_.y);
    }
    if (missing > 0.0 && first_.y < last_.y) {
        lines_[1].push_back({first_.y, missing});
    }
    missing = 0.0;
    for (; first_.y < last_.y && length(last_.y - 1) < 1.0; --last_.y) {
        missing += 1.0 - length(last_.y - 1);
    }
    if (missing > 0.0 && first_.y < last_.y) {
        lines_[1].push_back({last_.y, missing});
    }
}

double ShorterCells::shift_between(glm::ivec2 low, glm::ivec2 high) const {
    double shift = 0.0;
    for (const int axis : {0, 1}) {
        for (const Line& line : lines_[static_cast<std::size_t>(axis)]) {
            shift += low[axis] < line.at && line.at < high[axis] ? line.missing : 0.0;
        }
    }
    return shift;
}

Bending bending_of(const Heightfield& heightfield, const Placement& placement,
                   const ShorterCells& shorter) {
    if (placement.kind() == PlacementKind::plane) {
        return {glm::length(heightfield.spacing), 0.0, 0.0};
    }
    const glm::dvec2 first(shorter.first_equal());
    const glm::dvec2 step =
        (glm::dvec2(shorter.last_equal()) - first) / static_cast<double>(lattice);
    Derivatives bound;
    for (int j = 0; j <= lattice - 2; ++j) {
        for (int i = 0; i <= lattice - 2; ++i) {
            for (const double height : {heightfield.range.low, heightfield.range.high}) {
                bound.add(derivatives_at(placement, first + glm::dvec2(i, j) * step, step, height));
            }
        }
    }
    return {first_margin * bound.first, second_margin * bound.second, first_margin * bound.turn};
}

} // namespace reljef::terrain
