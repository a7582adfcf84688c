#include "engine/terrain/mesh/tile_layout.h"

#include <algorithm>
#include <array>

#include <glm/common.hpp>

namespace reljef::terrain {
namespace {

// Nine places of a piece of ground at one height.
struct NinePlaces {
    std::array<std::array<glm::dvec3, 3>, 3> at; // by row and column

    // Second differences along a row, or along a column.
    [[nodiscard]] glm::dvec3 bend(std::size_t line, bool along_row) const {
        return glm::abs(place(line, 0, along_row) - 2.0 * place(line, 1, along_row) +
                        place(line, 2, along_row));
    }

    // Whether rows, or columns, bend by more than 60 degrees from end to end.
    [[nodiscard]] bool turns_far(bool along_row) const {
        constexpr double share = 0.25; // at 60 degrees: 2 - √3, 0.27 chords
        double chord = 0.0;
        double bent = 0.0;
        for (std::size_t line = 0; line < 3; ++line) {
            chord = std::max(chord,
                             glm::distance(place(line, 0, along_row), place(line, 2, along_row)));
            bent = std::max(bent, glm::length(bend(line, along_row)));
        }
        return bent > share * chord;
    }

private:
    [[nodiscard]] glm::dvec3 place(std::size_t line, std::size_t i, bool along_row) const {
        return along_row ? at[line][i] : at[i][line];
    }
};

NinePlaces nine_places(const Placement& placement, glm::dvec2 first, glm::dvec2 last,
                       double height) {
    NinePlaces places;
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t col = 0; col < 3; ++col) {
            const glm::dvec2 sample = glm::mix(first, last, 0.5 * glm::dvec2(col, row));
            places.at[row][col] = placement.world_from_sample({sample, height});
        }
    }
    return places;
}

// The ground bulges between nine places by at most an eighth of the second differences along and
// across. A quarter is added. Pieces that bend far are cut, at most `cuts` times.
void add_ground(const Placement& placement, glm::dvec2 first, glm::dvec2 last, double height,
                int cuts, Box& box) {
    const NinePlaces places = nine_places(placement, first, last, height);
    for (const int axis : {0, 1}) {
        if (cuts > 0 && places.turns_far(axis == 0)) {
            glm::dvec2 middle_last = last;
            glm::dvec2 middle_first = first;
            middle_last[axis] = middle_first[axis] = 0.5 * (first[axis] + last[axis]);
            add_ground(placement, first, middle_last, height, cuts - 1, box);
            add_ground(placement, middle_first, last, height, cuts - 1, box);
            return;
        }
    }
    glm::dvec3 bulge(0.0);
    Box around;
    for (std::size_t i = 0; i < 3; ++i) {
        bulge = glm::max(bulge, 0.25 * (places.bend(i, true) + places.bend(i, false)));
        for (const glm::dvec3& place : places.at[i]) {
            around.add(place);
        }
    }
    box.add(Box{around.low - bulge, around.high + bulge});
}

} // namespace

Box placed_bounds(const Placement& placement, glm::dvec2 first, glm::dvec2 last,
                  HeightRange range) {
    constexpr int max_cuts = 10; // a globe needs 3 along its rows, and 2 across
    Box box;
    for (const double height : {range.low, range.high}) {
        if (placement.kind() == PlacementKind::plane) {
            box.add(placement.world_from_sample({first, height}));
            box.add(placement.world_from_sample({last, height}));
        } else {
            add_ground(placement, first, last, height, max_cuts, box);
        }
    }
    return box;
}

std::vector<TileCells> tile_layout(glm::ivec2 cells) {
    std::vector<TileCells> tiles;
    for (int row = 0; row < cells.y; row += tile_cells) {
        for (int col = 0; col < cells.x; col += tile_cells) {
            const glm::ivec2 first(col, row);
            tiles.push_back({first, glm::min(cells - first, glm::ivec2(tile_cells))});
        }
    }
    return tiles;
}

} // namespace reljef::terrain
