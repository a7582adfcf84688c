#include "engine/terrain/mesh/tile_layout.h"

#include <algorithm>
#include <array>

#include <glm/common.hpp>

namespace reljef::terrain {
namespace {

HeightRange range_of(const Grid<float>& heights, const Tile& tile) {
    HeightRange range{heights(tile.col, tile.row), heights(tile.col, tile.row)};
    for (int row = tile.row; row <= tile.row + tile.rows; ++row) {
        const auto samples = heights.row(row).subspan(static_cast<std::size_t>(tile.col),
                                                      static_cast<std::size_t>(tile.cols) + 1);
        const auto [low, high] = std::minmax_element(samples.begin(), samples.end());
        range = {std::min<double>(range.low, *low), std::max<double>(range.high, *high)};
    }
    return range;
}

// The second difference of three places.
glm::dvec3 bend(glm::dvec3 from, glm::dvec3 middle, glm::dvec3 to) {
    return glm::abs(from - 2.0 * middle + to);
}

template <class RangeOfTile>
std::vector<Tile> cut(const Heightfield& heightfield, const Placement& placement,
                      const RangeOfTile& range_of_tile) {
    const int cols = heightfield.heights.cols() - 1;
    const int rows = heightfield.heights.rows() - 1;
    std::vector<Tile> tiles;
    for (int row = 0; row < rows; row += tile_cells) {
        for (int col = 0; col < cols; col += tile_cells) {
            Tile tile{
                col, row, std::min(tile_cells, cols - col), std::min(tile_cells, rows - row), {}};
            tile.bounds =
                placed_bounds(placement, glm::dvec2(col, row),
                              glm::dvec2(col + tile.cols, row + tile.rows), range_of_tile(tile));
            tiles.push_back(tile);
        }
    }
    return tiles;
}

} // namespace

// The box around nine places at the lowest and highest height. On the ellipsoid the ground bulges
// between them by at most an eighth of the second differences along and across. A quarter is added.
Box placed_bounds(const Placement& placement, glm::dvec2 first, glm::dvec2 last,
                  HeightRange range) {
    Box box;
    glm::dvec3 max_bend(0.0);
    for (const double height : {range.low, range.high}) {
        std::array<std::array<glm::dvec3, 3>, 3> places;
        for (std::size_t j = 0; j < 3; ++j) {
            for (std::size_t i = 0; i < 3; ++i) {
                const glm::dvec2 part = 0.5 * glm::dvec2(i, j);
                places[j][i] = placement.world_from_sample({glm::mix(first, last, part), height});
                box.add(places[j][i]);
            }
        }
        for (std::size_t k = 0; k < 3; ++k) {
            max_bend = glm::max(max_bend, bend(places[k][0], places[k][1], places[k][2]) +
                                              bend(places[0][k], places[1][k], places[2][k]));
        }
    }
    if (placement.kind() == PlacementKind::ellipsoid) {
        box.low -= 0.25 * max_bend;
        box.high += 0.25 * max_bend;
    }
    return box;
}

std::vector<Tile> tile_layout(const Heightfield& heightfield, const Placement& placement) {
    return cut(heightfield, placement,
               [&](const Tile& tile) { return range_of(heightfield.heights, tile); });
}

std::vector<Tile> flat_tile_layout(const Heightfield& heightfield, const Placement& placement,
                                   double height) {
    return cut(heightfield, placement, [&](const Tile&) { return HeightRange{height, height}; });
}

} // namespace reljef::terrain
