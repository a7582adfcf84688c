#include "engine/terrain/tree/shared_splits.h"

#include <algorithm>
#include <utility>

#include "engine/terrain/mesh/tile_layout.h"

namespace reljef::terrain {
namespace {

// The sides of a tile, each the samples between two corners. Splits are nested: where one is not
// made, none is between it and its neighbours.
class BorderWalk {
public:
    BorderWalk(const Bisection& bisection, const ErrorView& view)
        : bisection_(bisection), view_(view), cells_(bisection.end() / steps_per_sample) {}

    std::vector<glm::ivec2> walk() && {
        // Where a side ends before tile_cells, bisection makes all of the splits along its end.
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
                bisection_.split(steps_per_sample * middle, steps_per_sample * size, true);
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
    SplitSharer(const TileTree& tree, const TileCover& cover) : cover_(cover) {
        for (const TreeTile tile : cover.tiles()) {
            const glm::ivec2 cells = tree.cells(tile);
            splits_.emplace(tile, Grid<std::uint8_t>(cells.x + 1, cells.y + 1));
        }
        for (const auto& entry : splits_) {
            add_corners(entry.first, tree.cells(entry.first));
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
    void add_corners(TreeTile tile, glm::ivec2 cells) {
        for (const glm::ivec2 corner :
             {glm::ivec2(0), glm::ivec2(cells.x, 0), glm::ivec2(0, cells.y), cells}) {
            add({tile, corner});
        }
    }

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

    const TileCover& cover_;
    SharedSplits splits_;
    std::vector<TreeVertex> open_;
};

} // namespace

std::vector<glm::ivec2> border_splits(const Bisection& bisection, const ErrorView& view) {
    return BorderWalk(bisection, view).walk();
}

SharedSplits shared_splits(const TileTree& tree, const TileCover& cover,
                           const BorderSplits& wanted) {
    SplitSharer sharer(tree, cover);
    for (const TreeTile tile : cover.tiles()) {
        for (const glm::ivec2 vertex : wanted.at(tile)) {
            sharer.add({tile, vertex});
        }
    }
    return sharer.take();
}

} // namespace reljef::terrain
