#include "engine/cast/tile_pieces.h"

#include <algorithm>
#include <map>
#include <set>

#include "engine/cast/block_kernel.h"

namespace reljef::cast {
namespace {

// Lines along both axes divide a plane into quadrants. A ray comes from the first of them, and
// passes the last one after all others: it crosses each line once.
int quadrant_order(bool is_east, bool is_south, glm::bvec2 from) {
    return (is_east != from.x ? 1 : 0) + (is_south != from.y ? 2 : 0);
}

glm::bvec2 side_of(glm::dvec2 place, glm::dvec2 lines) {
    return {place.x >= lines.x, place.y >= lines.y};
}

class TreeWalk {
public:
    TreeWalk(const terrain::TileTree& tree, std::span<const terrain::TreeTile> drawn,
             glm::dvec2 from)
        : tree_(tree), from_(from) {
        for (std::size_t i = 0; i < drawn.size(); ++i) {
            drawn_.emplace(drawn[i], i);
            terrain::TreeTile tile = drawn[i];
            while (tile.level < tree.root().level) {
                tile = {tile.level + 1, tile.col / 2, tile.row / 2};
                if (!parents_.insert(tile).second) {
                    break;
                }
            }
        }
    }

    std::vector<std::size_t> run() {
        visit(tree_.root());
        return std::move(order_);
    }

private:
    void visit(terrain::TreeTile tile) {
        if (const auto found = drawn_.find(tile); found != drawn_.end()) {
            order_.push_back(found->second);
            return;
        }
        if (!parents_.contains(tile)) {
            return;
        }
        std::vector<terrain::TreeTile> children = tree_.children(tile);
        const terrain::TreeTile middle{tile.level - 1, 2 * tile.col + 1, 2 * tile.row + 1};
        const glm::bvec2 from = side_of(from_, glm::dvec2(terrain::TileTree::first(middle)));
        const auto order = [&](terrain::TreeTile child) {
            return quadrant_order(child.col % 2 == 1, child.row % 2 == 1, from);
        };
        std::sort(children.begin(), children.end(),
                  [&](auto a, auto b) { return order(a) < order(b); });
        for (const terrain::TreeTile child : children) {
            visit(child);
        }
    }

    const terrain::TileTree& tree_;
    glm::dvec2 from_;
    std::map<terrain::TreeTile, std::size_t> drawn_;
    std::set<terrain::TreeTile> parents_;
    std::vector<std::size_t> order_;
};

TilePiece piece_of(const terrain::TileLattice& tile, glm::ivec2 first, glm::ivec2 end,
                   glm::dvec2 last) {
    TilePiece piece;
    piece.vertex = first;
    piece.cells = end - first;
    const auto sample = [&](glm::ivec2 vertex) {
        const glm::dvec2 regular = tile.first + tile.step * glm::dvec2(vertex);
        return glm::dvec2(vertex.x == tile.cells.x ? tile.last.x : regular.x,
                          vertex.y == tile.cells.y ? tile.last.y : regular.y);
    };
    piece.first = sample(first);
    piece.step = (sample(end) - piece.first) / glm::dvec2(piece.cells);
    const auto wall = [&](bool is_inside, unsigned side) { piece.walls |= is_inside ? side : 0U; };
    wall(piece.first.x > 0.0, west_wall);
    wall(piece.first.y > 0.0, north_wall);
    wall(sample(end).x < last.x, east_wall);
    wall(sample(end).y < last.y, south_wall);
    return piece;
}

} // namespace

std::vector<TilePiece> pieces_of(const terrain::TileLattice& tile, glm::dvec2 last,
                                 glm::dvec2 from) {
    const glm::ivec2 shorter = tile.shorter_from();
    const glm::bvec2 side = side_of(from, tile.first + tile.step * glm::dvec2(shorter));
    std::vector<TilePiece> pieces;
    for (int order = 0; order < 4; ++order) {
        const bool is_east = ((order & 1) != 0) != side.x;
        const bool is_south = ((order & 2) != 0) != side.y;
        const glm::ivec2 first(is_east ? shorter.x : 0, is_south ? shorter.y : 0);
        const glm::ivec2 end(is_east ? tile.cells.x : shorter.x,
                             is_south ? tile.cells.y : shorter.y);
        if (first.x < end.x && first.y < end.y) {
            pieces.push_back(piece_of(tile, first, end, last));
        }
    }
    return pieces;
}

std::vector<std::size_t> front_to_back(const terrain::TileTree& tree,
                                       std::span<const terrain::TreeTile> drawn, glm::dvec2 from) {
    return TreeWalk(tree, drawn, from).run();
}

} // namespace reljef::cast
