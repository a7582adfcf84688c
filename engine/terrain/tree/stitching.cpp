#include "engine/terrain/tree/stitching.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "engine/terrain/mesh/tile_layout.h"

namespace reljef::terrain {
namespace {

// The one or two tiles of a level that touch a sample along one axis.
std::vector<int> touching(int sample, int size) {
    const int tile = sample / size;
    return sample % size == 0 && tile > 0 ? std::vector<int>{tile - 1, tile}
                                          : std::vector<int>{tile};
}

class Edges {
public:
    Edges(const TileTree& tree, const std::set<TreeTile>& drawn) : tree_(tree), drawn_(drawn) {}

    // The vertex for a sample on the border of a drawn tile. If it is a tile's corner, an even
    // coarser tile may touch it, which then decides.
    [[nodiscard]] TreeVertex resolve(glm::ivec2 sample) const {
        TreeVertex found = nearest(*coarsest_at(sample), sample);
        for (glm::ivec2 place = place_of(found); place != sample && is_corner(found);
             place = place_of(found)) {
            sample = place;
            found = nearest(*coarsest_at(sample), sample);
        }
        return found;
    }

    // The equal or coarser drawn neighbour towards `side` (one step in col or row), if any.
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

    // The vertex for a sample inside the side along `neighbour`.
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

    // The tile columns that touch a sample, those at the first end first.
    [[nodiscard]] std::vector<int> cols_at(int sample, int size) const {
        const int other = tree_.other_end(sample);
        std::vector<int> cols = touching(std::min(sample, other), size);
        if (other != sample) {
            const std::vector<int> more = touching(std::max(sample, other), size);
            cols.insert(cols.end(), more.begin(), more.end());
        }
        return cols;
    }

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
            const bool at_end = at >= samples - 1; // the raster's end may cut the last cell
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

std::array<glm::ivec2, 4> corners_of(glm::ivec2 cells) {
    return {glm::ivec2(0), glm::ivec2(cells.x, 0), glm::ivec2(0, cells.y), cells};
}

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

bool touch(const TileTree& tree, TreeTile a, TreeTile b) {
    const glm::ivec2 first_a = TileTree::first(a);
    const glm::ivec2 first_b = TileTree::first(b);
    const glm::ivec2 last_a = tree.sample(a, tree.cells(a));
    const glm::ivec2 last_b = tree.sample(b, tree.cells(b));
    const auto reaches_around = [&](int last, int first) {
        return tree.wraps_longitude() && first == 0 && tree.other_end(last) == 0;
    };
    const bool across = (first_a.x <= last_b.x && first_b.x <= last_a.x) ||
                        reaches_around(last_a.x, first_b.x) || reaches_around(last_b.x, first_a.x);
    return across && first_a.y <= last_b.y && first_b.y <= last_a.y;
}

// The vertex of a tile at exactly this sample.
std::optional<glm::ivec2> vertex_at(const TileTree& tree, TreeTile tile, glm::ivec2 sample) {
    const glm::ivec2 first = TileTree::first(tile);
    const glm::ivec2 cells = tree.cells(tile);
    const int step = TileTree::step(tile);
    if (sample.x < first.x || sample.y < first.y) {
        return std::nullopt;
    }
    const glm::ivec2 vertex = glm::min((sample - first + step - 1) / step, cells);
    return tree.sample(tile, vertex) == sample ? std::optional(vertex) : std::nullopt;
}

// Finds the splits along the sides of a tile. Splits are nested: a split that is not made has no
// descendants.
class BorderWalk {
public:
    BorderWalk(const Bisection& bisection, const ErrorView& view)
        : bisection_(bisection), view_(view), cells_(sample_before(bisection.end())) {}

    std::vector<glm::ivec2> walk() && {
        // If a side is shorter than tile_cells, bisection makes all splits along the far side.
        const glm::ivec2 along_row(1, 0);
        const glm::ivec2 along_col(0, 1);
        add({0, 0}, along_row, tile_cells);
        add({0, 0}, along_col, tile_cells);
        add_far_side({0, cells_.y}, along_row, cells_.y);
        add_far_side({cells_.x, 0}, along_col, cells_.x);
        return std::move(made_);
    }

private:
    void add_far_side(glm::ivec2 first, glm::ivec2 along, int across) {
        if (across == tile_cells) {
            add(first, along, tile_cells);
        }
    }

    void add(glm::ivec2 first, glm::ivec2 along, int size) {
        const int half = size / 2;
        const glm::ivec2 middle = first + half * along;
        if (half == 0 || first.x >= cells_.x + along.y || first.y >= cells_.y + along.x) {
            return;
        }
        if (is_inside(middle)) {
            const Split split =
                bisection_.split(steps_of(middle), steps_per_sample * size, true);
            if (!exceeds(view_, split)) {
                return;
            }
            made_.push_back(middle);
        }
        add(first, along, half);
        add(middle, along, half);
    }

    [[nodiscard]] bool is_inside(glm::ivec2 vertex) const {
        return vertex.x <= cells_.x && vertex.y <= cells_.y;
    }

    const Bisection& bisection_;
    const ErrorView& view_;
    glm::ivec2 cells_;
    std::vector<glm::ivec2> made_;
};

int low_bit(int value) {
    return value == 0 ? tile_cells : value & -value;
}

class SplitSharer {
public:
    SplitSharer(const TileTree& tree, const DrawnTiles& cover) : cover_(cover) {
        for (const TreeTile tile : cover.tiles()) {
            const glm::ivec2 cells = tree.cells(tile);
            splits_.emplace(tile, Grid<std::uint8_t>(cells.x + 1, cells.y + 1));
        }
        for (const auto& entry : splits_) {
            for (const glm::ivec2 corner : corners_of(tree.cells(entry.first))) {
                add({entry.first, corner});
            }
        }
    }

    void add(const TreeVertex& vertex) {
        open_.push_back(vertex);
        while (!open_.empty()) {
            const TreeVertex next = open_.back();
            open_.pop_back();
            mark(next);
        }
    }

    SharedSplits take() { return std::move(splits_); }

private:
    void mark(const TreeVertex& at) {
        Grid<std::uint8_t>& splits = splits_.at(at.tile);
        const glm::ivec2 place = at.vertex;
        const glm::ivec2 last(splits.cols() - 1, splits.rows() - 1);
        const bool is_outside =
            std::min(place.x, place.y) < 0 || place.x > last.x || place.y > last.y;
        if (is_outside || splits(place.x, place.y) != 0) {
            return;
        }
        splits(place.x, place.y) = 1;
        if (place.x % last.x == 0 || place.y % last.y == 0) {
            const auto partners = cover_.partners(at);
            open_.insert(open_.end(), partners.begin(), partners.end());
        }
        const int half = std::min(low_bit(place.x), low_bit(place.y));
        if (half < tile_cells / 2) { // no corner, not the middle, nor that of a side
            const int size = 2 * half;
            const bool on_side = place.x % size == 0 || place.y % size == 0;
            const glm::ivec2 across = halving_at(place, size, on_side).across;
            open_.push_back({at.tile, place + across});
            open_.push_back({at.tile, place - across});
        }
    }

    const DrawnTiles& cover_;
    SharedSplits splits_;
    std::vector<TreeVertex> open_;
};

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
    for (const glm::ivec2 corner : corners_of(cells)) {
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

DrawnTiles::DrawnTiles(const TileTree& tree, std::set<TreeTile> drawn)
    : tree_(tree), tiles_(std::move(drawn)) {
    for (const TreeTile tile : tiles_) {
        TileEdges& edges = edges_[tile];
        edges.moves = edge_moves(tree_, tiles_, tile);
        for (const EdgeMove& move : edges.moves) {
            edges.moved.emplace(number_of({tile, move.vertex}), move.to);
        }
        std::copy_if(tiles_.begin(), tiles_.end(), std::back_inserter(edges.touching),
                     [&](TreeTile other) { return other != tile && touch(tree_, tile, other); });
    }
}

std::vector<TreeVertex> DrawnTiles::partners(const TreeVertex& vertex) const {
    const TileEdges& edges = edges_.at(vertex.tile);
    std::vector<TreeVertex> found;
    const auto moved = edges.moved.find(number_of(vertex));
    if (moved != edges.moved.end()) {
        found.push_back(moved->second);
    }
    const glm::ivec2 sample = tree_.sample(vertex.tile, vertex.vertex);
    for (const TreeTile other : edges.touching) {
        auto there = vertex_at(tree_, other, sample);
        if (!there) {
            there = vertex_at(tree_, other, {tree_.other_end(sample.x), sample.y});
        }
        if (there) {
            found.push_back({other, *there});
        }
    }
    return found;
}

std::vector<glm::ivec2> border_splits(const Bisection& bisection, const ErrorView& view) {
    return BorderWalk(bisection, view).walk();
}

SharedSplits shared_splits(const TileTree& tree, const DrawnTiles& cover,
                           const BorderSplits& required) {
    SplitSharer sharer(tree, cover);
    for (const TreeTile tile : cover.tiles()) {
        for (const glm::ivec2 vertex : required.at(tile)) {
            sharer.add({tile, vertex});
        }
    }
    return sharer.take();
}

} // namespace reljef::terrain
