#include "engine/terrain/kept_border.h"

#include <algorithm>
#include <utility>

#include "engine/terrain/tile_layout.h"

namespace reljef::terrain {
namespace {

int low_bit(int value) {
    return value == 0 ? tile_cells : value & -value;
}

// A split needs the two at the apexes of the triangles that it halves.
class SplitMarker {
public:
    explicit SplitMarker(glm::ivec2 cells) : marks_(cells.x + 1, cells.y + 1) {}

    void mark(glm::ivec2 place) {
        if (place.x >= marks_.cols() || place.y >= marks_.rows() || marks_(place.x, place.y) != 0) {
            return;
        }
        marks_(place.x, place.y) = 1;
        const int half = std::min(low_bit(place.x), low_bit(place.y));
        if (half >= tile_cells / 2) {
            return; // a corner of the tile, its middle, or the middle of a side
        }
        const glm::ivec2 across = across_at(place, half);
        for (const glm::ivec2 apex : {place + across, place - across}) {
            if (apex.x >= 0 && apex.y >= 0) {
                mark(apex);
            }
        }
    }

    [[nodiscard]] Grid<std::uint8_t> take() { return std::move(marks_); }

private:
    static glm::ivec2 across_at(glm::ivec2 place, int half) {
        const int size = 2 * half;
        if (place.x % size != 0 && place.y % size != 0) { // in the middle of a square
            const bool falls = (place.x / size + place.y / size) % 2 == 0;
            return {half, falls ? -half : half};
        }
        return place.y % size == 0 ? glm::ivec2(0, half) : glm::ivec2(half, 0);
    }

    Grid<std::uint8_t> marks_;
};

} // namespace

Grid<std::uint8_t> splits_of_border(glm::ivec2 cells) {
    check(std::min(cells.x, cells.y) >= 1 && std::max(cells.x, cells.y) <= tile_cells,
          "a border of a tile was expected");
    SplitMarker marker(cells);
    for (int col = 0; col <= cells.x; ++col) {
        marker.mark({col, 0});
        marker.mark({col, cells.y});
    }
    for (int row = 0; row <= cells.y; ++row) {
        marker.mark({0, row});
        marker.mark({cells.x, row});
    }
    return marker.take();
}

} // namespace reljef::terrain
