#include "engine/view/triangles/open_sides.h"

#include <algorithm>
#include <array>
#include <limits>

namespace reljef::view {
namespace {

using terrain::TreeTile;

constexpr std::array all_sides{TileSide::north, TileSide::east, TileSide::south, TileSide::west};

glm::ivec2 way_to(TileSide side) {
    switch (side) {
    case TileSide::north:
        return {0, -1};
    case TileSide::east:
        return {1, 0};
    case TileSide::south:
        return {0, 1};
    case TileSide::west:
        break;
    }
    return {-1, 0};
}

TreeTile parent_of(TreeTile tile) {
    return {tile.level + 1, tile.col / 2, tile.row / 2};
}

} // namespace

TileSide opposite(TileSide side) {
    return all_sides[(static_cast<std::size_t>(side) + 2) % all_sides.size()];
}

bool runs_along_rows(TileSide side) {
    return side == TileSide::north || side == TileSide::south;
}

DrawnTiles::DrawnTiles(const terrain::TileTree& tree, std::span<const TreeTile> tiles)
    : tree_(tree), tiles_(tiles.begin(), tiles.end()) {
    for (TreeTile tile : tiles_) {
        while (tile.level < tree_.root().level && parents_.insert(parent_of(tile)).second) {
            tile = parent_of(tile);
        }
    }
}

std::vector<OpenSide> DrawnTiles::open_sides(TreeTile tile) const {
    std::vector<OpenSide> open;
    for (const TileSide side : all_sides) {
        const auto beyond = beside(tile, side);
        if (!beyond) {
            continue;
        }
        if (tiles_.contains(*beyond)) {
            if (side == TileSide::east || side == TileSide::south) {
                open.push_back(side_of(tile, side));
                open.back().neighbour = beyond;
            }
        } else if (const auto larger = drawn_around(*beyond)) {
            open.push_back(side_of(tile, side));
            open.back().neighbour = larger;
        } else {
            add_undrawn(*beyond, side, open);
        }
    }
    return open;
}

// The tile of the same size; absent beyond the terrain.
std::optional<TreeTile> DrawnTiles::beside(TreeTile tile, TileSide side) const {
    const int samples = terrain::tree_tile_cells << tile.level;
    const int cols = (tree_.cols() - 2) / samples + 1;
    const int rows = (tree_.rows() - 2) / samples + 1;
    TreeTile found{tile.level, tile.col + way_to(side).x, tile.row + way_to(side).y};
    if (tree_.wraps_longitude()) {
        found.col = (found.col + cols) % cols;
    }
    const bool is_inside = found.col >= 0 && found.row >= 0 && found.col < cols && found.row < rows;
    return is_inside ? std::optional(found) : std::nullopt;
}

std::optional<TreeTile> DrawnTiles::drawn_around(TreeTile tile) const {
    while (tile.level < tree_.root().level) {
        tile = parent_of(tile);
        if (tiles_.contains(tile)) {
            return tile;
        }
    }
    return std::nullopt;
}

// Adds the parts beside a tile's side where nothing is drawn. Smaller drawn tiles have their own
// open sides.
void DrawnTiles::add_undrawn(TreeTile beyond, TileSide side, std::vector<OpenSide>& sides) const {
    if (tiles_.contains(beyond)) {
        return;
    }
    if (!has_drawn_parts(beyond)) {
        sides.push_back(side_of(beyond, side));
        return;
    }
    const std::vector<TreeTile> parts = tree_.children(beyond);
    const auto distance = [&](TreeTile part) { // from the side
        return way_to(side).x * part.col + way_to(side).y * part.row;
    };
    int nearest = std::numeric_limits<int>::max();
    for (const TreeTile part : parts) {
        nearest = std::min(nearest, distance(part));
    }
    for (const TreeTile part : parts) {
        if (distance(part) == nearest) {
            add_undrawn(part, side, sides);
        }
    }
}

OpenSide DrawnTiles::side_of(TreeTile tile, TileSide side) const {
    const glm::ivec2 first = terrain::TileTree::first(tile);
    const glm::ivec2 last = tree_.sample(tile, tree_.cells(tile));
    const int axis = runs_along_rows(side) ? 0 : 1;
    return {side, static_cast<double>(first[axis]), static_cast<double>(last[axis]), {}};
}

} // namespace reljef::view
