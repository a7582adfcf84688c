#include "engine/terrain/tile_cover.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <glm/vector_relational.hpp>

namespace reljef::terrain {
namespace {

bool touch(const TileTree& tree, TreeTile a, TreeTile b) {
    const auto last = [&](TreeTile tile) { return tree.sample(tile, tree.cells(tile)); };
    return glm::all(glm::lessThanEqual(TileTree::first(a), last(b))) &&
           glm::all(glm::lessThanEqual(TileTree::first(b), last(a)));
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
        if (const auto there = vertex_at(tree_, other, sample)) {
            found.push_back({other, *there});
        }
    }
    return found;
}

int TileCover::number_of(const TreeVertex& vertex) const {
    return vertex.vertex.y * (tree_.cells(vertex.tile).x + 1) + vertex.vertex.x;
}

} // namespace reljef::terrain
