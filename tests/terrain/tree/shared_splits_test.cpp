#include "engine/terrain/tree/shared_splits.h"

#include <map>
#include <memory>
#include <random>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/terrain/made_bisection.h"

namespace reljef::terrain {
namespace {

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
        BorderSplits wanted;
        for (const auto& [tile, made] : made_) {
            wanted[tile] = border_splits(made->bisection, metres_view(errors.at(tile)));
        }
        const SharedSplits splits = shared_splits(tree_, cover_, wanted);
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
        for (const glm::ivec2 place : cut.vertices) {
            const glm::ivec2 own = place / steps_per_sample;
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
    TileCover cover_;
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
        for (const glm::ivec2 place :
             triangulate_samples(made.bisection, made.tiles.front(), view, none).vertices) {
            const glm::ivec2 vertex = place / steps_per_sample;
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
