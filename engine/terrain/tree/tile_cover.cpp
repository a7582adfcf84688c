#include "engine/terrain/tree/tile_cover.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace reljef::terrain {
namespace {

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

// The vertex of a tile at just that sample.
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

} // namespace

TileCover::TileCover(const TileTree& tree, std::set<TreeTile> drawn)
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

std::vector<TreeVertex> TileCover::partners(const TreeVertex& vertex) const {
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

int TileCover::number_of(const TreeVertex& vertex) const {
    return vertex.vertex.y * (tree_.cells(vertex.tile).x + 1) + vertex.vertex.x;
}

} // namespace reljef::terrain
