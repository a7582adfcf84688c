#include "engine/terrain/tile_layout.h"

#include <algorithm>

#include <glm/geometric.hpp>

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

// The box around a tile's nine border and middle places at its lowest and highest height. On a curved
// Earth the ground between them bulges by at most an eighth of the chord's square over the radius,
// which is what the farthest of the middles from its corners' box shows; twice that is added.
Box placed_bounds(const Placement& placement, const Tile& tile, HeightRange range) {
    Box corners;
    Box all;
    for (int j = 0; j <= 2; ++j) {
        for (int i = 0; i <= 2; ++i) {
            for (const double height : {range.low, range.high}) {
                const glm::dvec3 point = placement.world_from_sample(
                    {tile.col + 0.5 * i * tile.cols, tile.row + 0.5 * j * tile.rows, height});
                all.add(point);
                if (i != 1 && j != 1) {
                    corners.add(point);
                }
            }
        }
    }
    if (placement.kind() == PlacementKind::ellipsoid) {
        const glm::dvec3 bulge =
            glm::max(glm::abs(all.low - corners.low), glm::abs(all.high - corners.high));
        all.low -= bulge;
        all.high += bulge;
    }
    return all;
}

template <class RangeOfTile>
std::vector<Tile> cut(const Heightfield& heightfield, const Placement& placement,
                      const RangeOfTile& range_of_tile) {
    const int cols = heightfield.heights.cols() - 1;
    const int rows = heightfield.heights.rows() - 1;
    std::vector<Tile> tiles;
    for (int row = 0; row < rows; row += tile_cells) {
        for (int col = 0; col < cols; col += tile_cells) {
            Tile tile{col, row, std::min(tile_cells, cols - col), std::min(tile_cells, rows - row), {}};
            tile.bounds = placed_bounds(placement, tile, range_of_tile(tile));
            tiles.push_back(tile);
        }
    }
    return tiles;
}

} // namespace

std::vector<Tile> tile_layout(const Heightfield& heightfield, const Placement& placement) {
    return cut(heightfield, placement,
               [&](const Tile& tile) { return range_of(heightfield.heights, tile); });
}

std::vector<Tile> flat_tile_layout(const Heightfield& heightfield, const Placement& placement,
                                   double height) {
    return cut(heightfield, placement, [&](const Tile&) { return HeightRange{height, height}; });
}

double reference_height(const Heightfield& heightfield) {
    return 0.5 * (heightfield.range.low + heightfield.range.high);
}

} // namespace reljef::terrain
