#include "engine/cast/frame/tile_pieces.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "engine/cast/packet/block_kernel.h"
#include "engine/core/check.h"

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
    const auto even = [&](glm::ivec2 vertex) {
        return glm::dvec2(sample(vertex).x, tile.even_row(vertex.y));
    };
    piece.first = even(first);
    piece.step = (even(end) - piece.first) / glm::dvec2(piece.cells);
    const auto wall = [&](bool is_inside, unsigned side) { piece.walls |= is_inside ? side : 0U; };
    wall(sample(first).x > 0.0, west_wall);
    wall(sample(first).y > 0.0, north_wall);
    wall(sample(end).x < last.x, east_wall);
    wall(sample(end).y < last.y, south_wall);
    return piece;
}

// The vertices between which cells have one size.
std::vector<int> column_cuts(const terrain::TileLattice& tile) {
    std::vector<int> cuts{0};
    const int shorter = tile.shorter_from().x;
    if (shorter > 0 && shorter < tile.cells.x) {
        cuts.push_back(shorter);
    }
    cuts.push_back(tile.cells.x);
    return cuts;
}

std::vector<int> row_cuts(const terrain::TileLattice& tile) {
    std::vector<int> cuts{0};
    const auto size = [&](int row) { return tile.even_row(row + 1) - tile.even_row(row); };
    for (int row = 1; row < tile.cells.y; ++row) {
        if (size(row) != size(row - 1)) {
            cuts.push_back(row);
        }
    }
    cuts.push_back(tile.cells.y);
    check(cuts.size() <= static_cast<std::size_t>(max_tile_parts.y) + 1,
          "rows of a tile at two poles");
    return cuts;
}

} // namespace

std::vector<TilePiece> pieces_of(const terrain::TileLattice& tile, glm::dvec2 last,
                                 glm::dvec2 from) {
    const std::vector<int> cols = column_cuts(tile);
    const std::vector<int> rows = row_cuts(tile);
    const glm::ivec2 count(static_cast<int>(cols.size()) - 1, static_cast<int>(rows.size()) - 1);
    const glm::bvec2 side = side_of(from, tile.first + tile.step * glm::dvec2(cols[1], rows[1]));
    std::vector<TilePiece> pieces;
    for (int j = 0; j < count.y; ++j) {
        for (int i = 0; i < count.x; ++i) {
            const glm::ivec2 part(side.x ? count.x - 1 - i : i, side.y ? count.y - 1 - j : j);
            const auto col = static_cast<std::size_t>(part.x);
            const auto row = static_cast<std::size_t>(part.y);
            TilePiece& piece = pieces.emplace_back(
                piece_of(tile, {cols[col], rows[row]}, {cols[col + 1], rows[row + 1]}, last));
            piece.part = part;
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

// The pieces of the first row are in the north of the others.
int add_piece_nodes(std::span<const TilePiece> pieces, std::span<const TileNode> boxes,
                    TileNodes& nodes) {
    if (pieces.size() == 1) {
        nodes.push_back(boxes.front());
        return static_cast<int>(nodes.size()) - 1;
    }
    const auto in_row = static_cast<std::size_t>(
        std::count_if(pieces.begin(), pieces.end(),
                      [&](const TilePiece& piece) { return piece.part.y == pieces[0].part.y; }));
    const std::size_t over = nodes.size();
    nodes.emplace_back();
    std::array<int, 4> parts{-1, -1, -1, -1};
    glm::dvec2 lines(boxes.front().box.low);
    for (std::size_t i = 0; i < in_row; ++i) {
        parts[i] = static_cast<int>(nodes.size());
        nodes.push_back(boxes[i]);
        lines.x = boxes[i].box.low.x;
    }
    if (in_row < pieces.size()) {
        const int beside = static_cast<int>(nodes.size());
        nodes.push_back(node_over(nodes, parts, lines));
        lines.y = boxes[in_row].box.low.y;
        parts = {beside, -1, -1, -1};
        parts[2] = add_piece_nodes(pieces.subspan(in_row), boxes.subspan(in_row), nodes);
    }
    nodes[over] = node_over(nodes, parts, lines);
    return static_cast<int>(over);
}

TileNodes nodes_of(const terrain::TileTree& tree, std::span<const terrain::TreeTile> drawn,
                   const std::function<glm::dvec2(terrain::TreeTile)>& first_of,
                   const TileAdder& add_tile) {
    return NodeTree(DrawnTree(tree, drawn), first_of, add_tile).run();
}

} // namespace reljef::cast
