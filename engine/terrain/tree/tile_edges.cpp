#include "engine/terrain/tree/tile_edges.h"

#include <algorithm>
#include <array>
#include <optional>

namespace reljef::terrain {
namespace {

// Along one axis: the tiles of a level that touch a sample, one or two.
std::vector<int> touching(int sample, int size) {
    const int tile = sample / size;
    return sample % size == 0 && tile > 0 ? std::vector<int>{tile - 1, tile}
                                          : std::vector<int>{tile};
}

class Edges {
public:
    Edges(const TileTree& tree, const std::set<TreeTile>& drawn) : tree_(tree), drawn_(drawn) {}

    // The place for a sample on the border of a drawn tile. Coarser tiles have their vertices
    // fewer, so that from a corner the way may lead on to one that is coarser still.
    [[nodiscard]] TreeVertex resolve(glm::ivec2 sample) const {
        TreeVertex found = nearest(*coarsest_at(sample), sample);
        for (glm::ivec2 place = place_of(found); place != sample && is_corner(found);
             place = place_of(found)) {
            sample = place;
            found = nearest(*coarsest_at(sample), sample);
        }
        return found;
    }

    // The drawn tile along a whole side of a tile, towards `side` (one step in col or row); nothing
    // where there is none or only finer ones.
    [[nodiscard]] std::optional<TreeTile> beside(TreeTile tile, glm::ivec2 side) const {
        TreeTile neighbour{tile.level, tile.col + side.x, tile.row + side.y};
        if (tree_.wraps_longitude()) {
            const int cols = tree_.tile_cols(tile.level);
            neighbour.col = (neighbour.col + cols) % cols;
        }
        if (neighbour.col < 0 || neighbour.row < 0 || neighbour == tile) {
            return std::nullopt;
        }
        for (; neighbour.level <= tree_.root().level; ++neighbour.level) {
            if (drawn_.contains(neighbour)) {
                return neighbour;
            }
            neighbour.col /= 2;
            neighbour.row /= 2;
        }
        return std::nullopt;
    }

    // A vertex inside the side of a tile that lies along `neighbour`.
    [[nodiscard]] TreeVertex on_side(TreeTile neighbour, glm::ivec2 sample) const {
        const TreeVertex found = nearest(neighbour, sample);
        return is_corner(found) ? resolve(place_of(found)) : found;
    }

private:
    [[nodiscard]] std::optional<TreeTile> coarsest_at(glm::ivec2 sample) const {
        for (int level = tree_.root().level; level >= 0; --level) {
            const int size = tile_cells * TileTree::step({level, 0, 0});
            for (const int col : cols_at(sample.x, size)) {
                for (const int row : touching(sample.y, size)) {
                    if (drawn_.contains({level, col, row})) {
                        return TreeTile{level, col, row};
                    }
                }
            }
        }
        return std::nullopt;
    }

    // Of the level, the first first, whichever end the sample is at.
    [[nodiscard]] std::vector<int> cols_at(int sample, int size) const {
        const int other = tree_.other_end(sample);
        std::vector<int> cols = touching(std::min(sample, other), size);
        if (other != sample) {
            const std::vector<int> more = touching(std::max(sample, other), size);
            cols.insert(cols.end(), more.begin(), more.end());
        }
        return cols;
    }

    // A sample at an end lies at both.
    [[nodiscard]] int col_seen_from(TreeTile tile, int col) const {
        const int first = TileTree::first(tile).x;
        const int last = tree_.sample(tile, tree_.cells(tile)).x;
        return col >= first && col <= last ? col : tree_.other_end(col);
    }

    [[nodiscard]] TreeVertex nearest(TreeTile tile, glm::ivec2 sample) const {
        sample.x = col_seen_from(tile, sample.x);
        const glm::ivec2 first = TileTree::first(tile);
        const glm::ivec2 cells = tree_.cells(tile);
        const int step = TileTree::step(tile);
        const auto along = [&](int at, int begin, int count, int samples) {
            const bool at_end = at >= samples - 1; // of the raster, where the last cell is cut
            return at_end ? count : std::min((at - begin + step / 2) / step, count);
        };
        return {tile,
                {along(sample.x, first.x, cells.x, tree_.cols()),
                 along(sample.y, first.y, cells.y, tree_.rows())}};
    }

    [[nodiscard]] glm::ivec2 place_of(const TreeVertex& vertex) const {
        return tree_.sample(vertex.tile, vertex.vertex);
    }

    [[nodiscard]] bool is_corner(const TreeVertex& vertex) const {
        const glm::ivec2 cells = tree_.cells(vertex.tile);
        return vertex.vertex.x % cells.x == 0 && vertex.vertex.y % cells.y == 0;
    }

    const TileTree& tree_;
    const std::set<TreeTile>& drawn_;
};

// One side of a tile: the vertices between its corners.
struct TileSide {
    glm::ivec2 outwards;
    glm::ivec2 begin; // corner
    glm::ivec2 along;
    int cells = 0;
};

std::array<TileSide, 4> sides_of(glm::ivec2 cells) {
    return {TileSide{{0, -1}, {0, 0}, {1, 0}, cells.x},
            TileSide{{0, 1}, {0, cells.y}, {1, 0}, cells.x},
            TileSide{{-1, 0}, {0, 0}, {0, 1}, cells.y},
            TileSide{{1, 0}, {cells.x, 0}, {0, 1}, cells.y}};
}

} // namespace

std::vector<EdgeMove> edge_moves(const TileTree& tree, const std::set<TreeTile>& drawn,
                                 TreeTile tile) {
    check(drawn.contains(tile), "edges of a tile that is not drawn");
    const Edges edges(tree, drawn);
    const glm::ivec2 cells = tree.cells(tile);
    std::vector<EdgeMove> moves;
    const auto add = [&](glm::ivec2 vertex, const TreeVertex& to) {
        if (to != TreeVertex{tile, vertex}) {
            moves.push_back({vertex, to});
        }
    };
    for (const glm::ivec2 corner :
         {glm::ivec2(0), glm::ivec2(cells.x, 0), glm::ivec2(0, cells.y), cells}) {
        add(corner, edges.resolve(tree.sample(tile, corner)));
    }
    for (const TileSide& side : sides_of(cells)) {
        const auto neighbour = edges.beside(tile, side.outwards);
        if (!neighbour || (neighbour->level == tile.level && tile < *neighbour)) {
            continue;
        }
        for (int i = 1; i < side.cells; ++i) {
            const glm::ivec2 vertex = side.begin + i * side.along;
            add(vertex, edges.on_side(*neighbour, tree.sample(tile, vertex)));
        }
    }
    return moves;
}

} // namespace reljef::terrain
