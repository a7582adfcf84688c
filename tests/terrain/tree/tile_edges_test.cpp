#include "engine/terrain/tree/tile_edges.h"

#include <algorithm>
#include <functional>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/release_only.h"

namespace reljef::terrain {
namespace {

using Place = std::pair<int, int>; // sample

TEST(TileTree, TheRootCoversAllAndChildrenCoverTheirParent) {
    for (const auto& [cols, rows] :
         {std::pair(2, 2), {129, 129}, {130, 129}, {1000, 3}, {70000, 65537}, {1 << 30, 2}}) {
        const TileTree tree(cols, rows);
        EXPECT_EQ(tree.sample(tree.root(), tree.cells(tree.root())),
                  glm::ivec2(cols - 1, rows - 1));
        for (TreeTile tile = tree.root(); tile.level > 0; tile = tree.children(tile).back()) {
            glm::ivec2 last(0);
            for (const TreeTile child : tree.children(tile)) {
                const glm::ivec2 cells = tree.cells(child);
                ASSERT_GE(std::min(cells.x, cells.y), 1);
                last = glm::max(last, tree.sample(child, cells));
            }
            ASSERT_EQ(last, tree.sample(tile, tree.cells(tile)));
        }
    }
}

/// A choice of tiles that covers the raster: some are split, at random.
std::set<TreeTile> random_cover(const TileTree& tree, std::mt19937& random, double split) {
    std::set<TreeTile> cover;
    std::vector<TreeTile> open{tree.root()};
    std::bernoulli_distribution splits(split);
    while (!open.empty()) {
        const TreeTile tile = open.back();
        open.pop_back();
        const auto children = tree.children(tile);
        if (!children.empty() && (tile.level > 4 || splits(random))) {
            open.insert(open.end(), children.begin(), children.end());
        } else {
            cover.insert(tile);
        }
    }
    return cover;
}

/// The vertices around a tile, each as the vertex whose place and height it takes.
std::vector<TreeVertex> outline(const TileTree& tree, const std::set<TreeTile>& cover,
                                TreeTile tile) {
    const glm::ivec2 cells = tree.cells(tile);
    std::map<Place, TreeVertex> moved;
    for (const EdgeMove& move : edge_moves(tree, cover, tile)) {
        moved.emplace(Place(move.vertex.x, move.vertex.y), move.to);
    }
    std::vector<TreeVertex> around;
    const auto add = [&](int col, int row) {
        const auto found = moved.find({col, row});
        around.push_back(found != moved.end() ? found->second : TreeVertex{tile, {col, row}});
    };
    for (int i = 0; i < cells.y; ++i) {
        add(0, i);
    }
    for (int i = 0; i < cells.x; ++i) {
        add(i, cells.y);
    }
    for (int i = cells.y; i > 0; --i) {
        add(cells.x, i);
    }
    for (int i = cells.x; i > 0; --i) {
        add(i, 0);
    }
    return around;
}

TEST(TileEdges, TilesOfAnyLevelsMeetVertexOnVertex) {
    RELJEF_RELEASE_ONLY("thousands of covers by the same few lines");
    // Each edge of an outline is its neighbour's, the other way round; what is left over is the
    // raster's own border. Vertices are told apart by whose height they have: no step either.
    // Around the Earth the two ends are neighbours, too.
    std::mt19937 random(7);
    for (int round = 0; round < 60; ++round) {
        const bool wraps_longitude = round % 3 == 2;
        constexpr int two_tiles = 2 * tile_cells * 16; // of the coarsest that covers have
        std::uniform_int_distribution<int> cols(wraps_longitude ? two_tiles : 2, 9000);
        std::uniform_int_distribution<int> rows(2, 9000);
        const TileTree tree(cols(random), rows(random), wraps_longitude);
        const auto cover = random_cover(tree, random, 0.15 + 0.01 * round);
        using Key = std::tuple<TreeTile, int, int>;
        std::map<std::pair<Key, Key>, int> edges;
        const auto key = [](const TreeVertex& v) { return Key(v.tile, v.vertex.x, v.vertex.y); };
        for (const TreeTile tile : cover) {
            const auto around = outline(tree, cover, tile);
            for (std::size_t i = 0; i < around.size(); ++i) {
                const Key from = key(around[i]);
                const Key to = key(around[(i + 1) % around.size()]);
                if (from != to && edges.erase({to, from}) == 0) {
                    ++edges[{from, to}];
                }
            }
        }
        const glm::ivec2 last(tree.cols() - 1, tree.rows() - 1);
        for (const auto& [edge, count] : edges) {
            ASSERT_EQ(count, 1);
            const auto place = [&](const Key& vertex) {
                const auto& [tile, col, row] = vertex;
                return tree.sample(tile, {col, row});
            };
            const glm::ivec2 a = place(edge.first);
            const glm::ivec2 b = place(edge.second);
            const bool on_border =
                (!wraps_longitude && a.x == b.x && (a.x == 0 || a.x == last.x)) ||
                (a.y == b.y && (a.y == 0 || a.y == last.y));
            ASSERT_TRUE(on_border)
                << "round " << round << ": " << a.x << "," << a.y << " to " << b.x << "," << b.y;
        }
    }
}

TEST(TileEdges, OnlyTheFinerTileIsMovedAndOnlyAlongItsBorder) {
    const TileTree tree(513, 513);
    std::set<TreeTile> cover{{1, 1, 0}, {1, 0, 1}, {1, 1, 1}};
    for (const TreeTile tile : tree.children({1, 0, 0})) {
        cover.insert(tile);
    }
    EXPECT_TRUE(edge_moves(tree, cover, {1, 1, 1}).empty() ||
                edge_moves(tree, cover, {1, 1, 1}).size() < 3U * 129U);
    for (const EdgeMove& move : edge_moves(tree, cover, {0, 1, 0})) {
        EXPECT_TRUE(move.vertex.x == 0 || move.vertex.x == 128 || move.vertex.y == 0 ||
                    move.vertex.y == 128);
        const glm::ivec2 from = tree.sample({0, 1, 0}, move.vertex);
        const glm::ivec2 to = tree.sample(move.to.tile, move.to.vertex);
        EXPECT_LE(std::max(std::abs(from.x - to.x), std::abs(from.y - to.y)), 1);
    }
}

} // namespace
} // namespace reljef::terrain
