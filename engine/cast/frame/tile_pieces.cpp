#include "engine/cast/frame/tile_pieces.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "engine/cast/packet/block_kernel.h"

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

// The quarter where four children of a tile meet.
terrain::TreeTile middle_of(terrain::TreeTile tile) {
    return {tile.level - 1, 2 * tile.col + 1, 2 * tile.row + 1};
}

// The part of a tree above drawn tiles.
class DrawnTree {
public:
    DrawnTree(const terrain::TileTree& tree, std::span<const terrain::TreeTile> drawn)
        : tree_(tree) {
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

    // The index of a drawn tile.
    [[nodiscard]] std::optional<std::size_t> find(terrain::TreeTile tile) const {
        const auto found = drawn_.find(tile);
        return found != drawn_.end() ? std::optional(found->second) : std::nullopt;
    }
    // Those that are drawn, or lie above drawn ones.
    [[nodiscard]] std::vector<terrain::TreeTile> children(terrain::TreeTile tile) const {
        std::vector<terrain::TreeTile> children;
        if (parents_.contains(tile)) {
            children = tree_.children(tile);
            std::erase_if(children, [&](terrain::TreeTile child) {
                return !drawn_.contains(child) && !parents_.contains(child);
            });
        }
        return children;
    }
    [[nodiscard]] terrain::TreeTile root() const { return tree_.root(); }

private:
    const terrain::TileTree& tree_;
    std::map<terrain::TreeTile, std::size_t> drawn_;
    std::set<terrain::TreeTile> parents_;
};

class TreeWalk {
public:
    TreeWalk(const DrawnTree& tree, glm::dvec2 from) : tree_(tree), from_(from) {}

    std::vector<std::size_t> run() {
        visit(tree_.root());
        return std::move(order_);
    }

private:
    void visit(terrain::TreeTile tile) {
        if (const auto found = tree_.find(tile)) {
            order_.push_back(*found);
            return;
        }
        std::vector<terrain::TreeTile> children = tree_.children(tile);
        const glm::bvec2 from =
            side_of(from_, glm::dvec2(terrain::TileTree::first(middle_of(tile))));
        const auto order = [&](terrain::TreeTile child) {
            return quadrant_order(child.col % 2 == 1, child.row % 2 == 1, from);
        };
        std::sort(children.begin(), children.end(),
                  [&](auto a, auto b) { return order(a) < order(b); });
        for (const terrain::TreeTile child : children) {
            visit(child);
        }
    }

    const DrawnTree& tree_;
    glm::dvec2 from_;
    std::vector<std::size_t> order_;
};

class NodeTree {
public:
    NodeTree(const DrawnTree& tree, const std::function<glm::dvec2(terrain::TreeTile)>& first_of,
             const TileAdder& add_tile)
        : tree_(tree), first_of_(first_of), add_tile_(add_tile) {}

    TileNodes run() {
        add(tree_.root());
        return std::move(nodes_);
    }

private:
    int add(terrain::TreeTile tile) {
        if (const auto found = tree_.find(tile)) {
            return add_tile_(*found, nodes_);
        }
        const std::size_t index = nodes_.size();
        nodes_.emplace_back();
        std::array<int, 4> parts{-1, -1, -1, -1};
        for (const terrain::TreeTile child : tree_.children(tile)) {
            parts[static_cast<std::size_t>(child.col % 2 + 2 * (child.row % 2))] = add(child);
        }
        nodes_[index] = node_over(nodes_, parts, first_of_(middle_of(tile)));
        return static_cast<int>(index);
    }

    const DrawnTree& tree_;
    const std::function<glm::dvec2(terrain::TreeTile)>& first_of_;
    const TileAdder& add_tile_;
    TileNodes nodes_;
};

PixelBlock around(const PixelBlock& a, const PixelBlock& b) {
    const glm::ivec2 first = glm::min(a.first, b.first);
    return {first, glm::max(a.first + a.size, b.first + b.size) - first};
}

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
    return TreeWalk(DrawnTree(tree, drawn), from).run();
}

TileNode node_over(const TileNodes& nodes, const std::array<int, 4>& parts, glm::dvec2 lines) {
    TileNode node;
    node.lines = lines;
    node.parts = parts;
    for (const int part : parts) {
        if (part >= 0) {
            const TileNode& below = nodes[static_cast<std::size_t>(part)];
            node.seen = node.box.empty() ? below.seen : around(node.seen, below.seen);
            node.box.add(below.box);
        }
    }
    return node;
}

TileNodes nodes_of(const terrain::TileTree& tree, std::span<const terrain::TreeTile> drawn,
                   const std::function<glm::dvec2(terrain::TreeTile)>& first_of,
                   const TileAdder& add_tile) {
    return NodeTree(DrawnTree(tree, drawn), first_of, add_tile).run();
}

} // namespace reljef::cast
