#include "engine/terrain/tree/stitching.h"

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/release_only.h"
#include "tests/terrain/made_bisection.h"

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

ErrorView metres_view(double max_error) {
    ErrorView view;
    view.perspective = false;
    view.max_error = max_error;
    return view;
}

/// Tiles of a cover with their heights, each cut for an error of its own.
class MadeCover {
public:
    MadeCover(const TileTree& tree, std::set<TreeTile> tiles) : tree_(tree), cover_(tree, tiles) {
        for (const TreeTile tile : tiles) {
            const glm::ivec2 cells = tree.cells(tile);
            const auto seed = static_cast<unsigned>(1 + tile.level + 8 * tile.col + 64 * tile.row);
            made_[tile] = std::make_unique<test::PlacedTerrain>(test::MadeTerrain{
                "", test::plane_heightfield(test::rough_hills(cells.x + 1, cells.y + 1, seed))});
        }
    }

    void cut(const std::map<TreeTile, double>& errors) {
        BorderSplits requested;
        for (const auto& [tile, made] : made_) {
            requested[tile] = border_splits(made->bisection, metres_view(errors.at(tile)));
        }
        const SharedSplits splits = shared_splits(tree_, cover_, requested);
        for (const auto& [tile, made] : made_) {
            cuts_[tile] = triangulate_samples(made->bisection, made->tiles.front(),
                                              metres_view(errors.at(tile)), splits.at(tile));
        }
    }

    using Key = std::tuple<TreeTile, int, int>;
    /// Edges of all triangles without their opposite, vertices where they are drawn.
    [[nodiscard]] std::map<std::pair<Key, Key>, int> open_edges() const {
        std::map<std::pair<Key, Key>, int> open;
        for (const auto& [tile, cut] : cuts_) {
            const auto keys = drawn_vertices(tile, cut);
            for (std::size_t i = 0; i < cut.indices.size(); i += 3) {
                const std::array corners{keys[cut.indices[i]], keys[cut.indices[i + 1]],
                                         keys[cut.indices[i + 2]]};
                for (std::size_t k = 0; k < 3; ++k) {
                    add_edge(open, corners[k], corners[(k + 1) % 3]);
                }
            }
        }
        return open;
    }
    [[nodiscard]] glm::ivec2 sample(const Key& key) const {
        const auto& [tile, col, row] = key;
        return tree_.sample(tile, {col, row});
    }
    [[nodiscard]] std::size_t triangles(TreeTile tile) const {
        return cuts_.at(tile).indices.size() / 3;
    }

private:
    [[nodiscard]] std::vector<Key> drawn_vertices(TreeTile tile, const Triangulation& cut) const {
        std::map<std::pair<int, int>, TreeVertex> moved;
        for (const EdgeMove& move : cover_.moves(tile)) {
            moved.emplace(std::pair(move.vertex.x, move.vertex.y), move.to);
        }
        std::vector<Key> keys;
        for (const Steps place : cut.vertices) {
            const glm::ivec2 own = sample_before(place);
            const auto found = moved.find({own.x, own.y});
            const TreeVertex at = found == moved.end() ? TreeVertex{tile, own} : found->second;
            keys.emplace_back(at.tile, at.vertex.x, at.vertex.y);
        }
        return keys;
    }

    static void add_edge(std::map<std::pair<Key, Key>, int>& open, const Key& from, const Key& to) {
        const auto opposite = open.find({to, from});
        if (from == to) {
            return; // a side that is moved away
        }
        if (opposite == open.end()) {
            ++open[{from, to}];
        } else if (--opposite->second == 0) {
            open.erase(opposite);
        }
    }

    TileTree tree_;
    DrawnTiles cover_;
    std::map<TreeTile, std::unique_ptr<test::PlacedTerrain>> made_;
    std::map<TreeTile, Triangulation> cuts_;
};

void expect_closed(const MadeCover& made, glm::ivec2 last) {
    for (const auto& [edge, count] : made.open_edges()) {
        const glm::ivec2 a = made.sample(edge.first);
        const glm::ivec2 b = made.sample(edge.second);
        const bool on_border = (a.x == b.x && (a.x == 0 || a.x == last.x)) ||
                               (a.y == b.y && (a.y == 0 || a.y == last.y));
        ASSERT_TRUE(on_border) << count << ": " << a.x << "," << a.y << " to " << b.x << "," << b.y;
    }
}

// The north-west of the raster in tiles of the two finest levels, the rest in coarser ones.
std::set<TreeTile> mixed_cover(const TileTree& tree) {
    std::set<TreeTile> cover;
    const auto north_west = [](TreeTile tile) { return tile.col == 0 && tile.row == 0; };
    for (TreeTile tile = tree.root(); tile.level > 0; tile = {tile.level - 1, 0, 0}) {
        for (const TreeTile child : tree.children(tile)) {
            if (!north_west(child) || child.level == 0) {
                cover.insert(child);
            }
        }
    }
    return cover;
}

TEST(SharedSplits, TilesOfAnyLevelsCutForAnyErrorsMeetVertexOnVertex) {
    std::mt19937 random(11);
    for (const glm::ivec2 samples : {glm::ivec2(513, 513), glm::ivec2(500, 300)}) {
        const TileTree tree(samples.x, samples.y);
        MadeCover made(tree, mixed_cover(tree));
        for (int round = 0; round < 3; ++round) {
            std::map<TreeTile, double> errors;
            for (const TreeTile tile : mixed_cover(tree)) {
                constexpr std::array choices{1e6, 40.0, 4.0, 0.5};
                errors[tile] = choices[random() % choices.size()];
            }
            made.cut(errors);
            ASSERT_NO_FATAL_FAILURE(expect_closed(made, samples - 1));
        }
    }
}

TEST(SharedSplits, ATileThatNoneNeedsFinerHasTheFewestTriangles) {
    const TileTree tree(257, 129);
    const TreeTile west{0, 0, 0};
    const TreeTile east{0, 1, 0};
    MadeCover made(tree, {west, east});
    made.cut({{west, 1e6}, {east, 1e6}});
    EXPECT_EQ(made.triangles(west), 4U);
    made.cut({{west, 1e6}, {east, 1e-3}});
    EXPECT_GT(made.triangles(west), 128U); // all of the side where they meet
    EXPECT_LT(made.triangles(west), 1024U);
}

TEST(SharedSplits, ThoseOfABorderAreTheOnesThatItsTrianglesHave) {
    for (const glm::ivec2 cells :
         {glm::ivec2(128, 128), glm::ivec2(128, 37), glm::ivec2(91, 128)}) {
        const test::PlacedTerrain made(
            {"", test::plane_heightfield(test::rough_hills(cells.x + 1, cells.y + 1, 3))});
        const ErrorView view = metres_view(6.0);
        const Grid<std::uint8_t> none(cells.x + 1, cells.y + 1);
        std::set<std::pair<int, int>> expected;
        for (const Steps place :
             triangulate_samples(made.bisection, made.tiles.front(), view, none).vertices) {
            const glm::ivec2 vertex = sample_before(place);
            const bool is_corner = vertex.x % cells.x == 0 && vertex.y % cells.y == 0;
            const bool on_side = vertex.x == 0 || vertex.y == 0 ||
                                 (vertex.x == cells.x && cells.x == tile_cells) ||
                                 (vertex.y == cells.y && cells.y == tile_cells);
            if (on_side && !is_corner) {
                expected.emplace(vertex.x, vertex.y);
            }
        }
        std::set<std::pair<int, int>> found;
        for (const glm::ivec2 vertex : border_splits(made.bisection, view)) {
            if (vertex.x % cells.x != 0 || vertex.y % cells.y != 0) {
                found.emplace(vertex.x, vertex.y);
            }
        }
        EXPECT_EQ(found, expected) << cells.x << " x " << cells.y;
        EXPECT_GT(found.size(), 8U);
    }
}

} // namespace
} // namespace reljef::terrain
