#include "engine/view/triangles/open_sides.h"

#include <map>
#include <tuple>

#include <glm/common.hpp>
#include <gtest/gtest.h>

#include "tests/terrain/chance.h"

namespace reljef::view {
namespace {

using terrain::TileTree;
using terrain::TreeTile;

// Some tiles of a tree, none of which covers another; parts of it have none.
void choose(const TileTree& tree, TreeTile tile, test::Chance& chance,
            std::vector<TreeTile>& chosen) {
    if (tile.level > 0 && chance.between(0.0, 1.0) < 0.7) {
        for (const TreeTile child : tree.children(tile)) {
            choose(tree, child, chance, chosen);
        }
    } else if (chance.between(0.0, 1.0) < 0.7) {
        chosen.push_back(tile);
    }
}

// The chosen tile that covers a tile of level 0.
std::optional<TreeTile> covering(const std::vector<TreeTile>& chosen, TreeTile tile, int levels) {
    for (; tile.level < levels; tile = {tile.level + 1, tile.col / 2, tile.row / 2}) {
        if (std::find(chosen.begin(), chosen.end(), tile) != chosen.end()) {
            return tile;
        }
    }
    return std::nullopt;
}

// A place at a border of level 0: the tile inside, the side, and whose seam is there, with whom.
using Place = std::tuple<int, int, TileSide>;
using Seam = std::pair<TreeTile, std::optional<TreeTile>>;

std::map<Place, Seam> expected_seams(const TileTree& tree, const std::vector<TreeTile>& chosen) {
    const int cells = terrain::tree_tile_cells;
    const glm::ivec2 tiles((tree.cols() - 2) / cells + 1, (tree.rows() - 2) / cells + 1);
    const int levels = tree.root().level + 1;
    std::map<Place, Seam> seams;
    const auto add = [&](glm::ivec2 inside, glm::ivec2 way, TileSide side) {
        glm::ivec2 beyond = inside + way;
        if (tree.wraps_longitude()) {
            beyond.x = (beyond.x + tiles.x) % tiles.x;
        }
        if (beyond.x < 0 || beyond.y < 0 || beyond.x >= tiles.x || beyond.y >= tiles.y) {
            return;
        }
        const auto own = covering(chosen, {0, inside.x, inside.y}, levels);
        const auto other = covering(chosen, {0, beyond.x, beyond.y}, levels);
        if (!own || (own == other && !(tree.wraps_longitude() && beyond.x != inside.x + way.x))) {
            return;
        }
        const bool is_first = side == TileSide::east || side == TileSide::south;
        if (!other || other->level > own->level || (other->level == own->level && is_first)) {
            seams[{inside.x, inside.y, side}] = {*own, other};
        }
    };
    for (int row = 0; row < tiles.y; ++row) {
        for (int col = 0; col < tiles.x; ++col) {
            add({col, row}, {0, -1}, TileSide::north);
            add({col, row}, {1, 0}, TileSide::east);
            add({col, row}, {0, 1}, TileSide::south);
            add({col, row}, {-1, 0}, TileSide::west);
        }
    }
    return seams;
}

std::map<Place, Seam> found_seams(const TileTree& tree, const std::vector<TreeTile>& chosen) {
    const DrawnTiles drawn(tree, chosen);
    const double cells = terrain::tree_tile_cells;
    std::map<Place, Seam> seams;
    for (const TreeTile tile : chosen) {
        const glm::ivec2 first = TileTree::first(tile) / terrain::tree_tile_cells;
        const glm::ivec2 last =
            (tree.sample(tile, tree.cells(tile)) - 1) / terrain::tree_tile_cells;
        for (const OpenSide& open : drawn.open_sides(tile)) {
            for (double at = open.from; at < open.to; at += cells) {
                const int along = static_cast<int>(at / cells);
                const glm::ivec2 place = open.side == TileSide::north   ? glm::ivec2(along, first.y)
                                         : open.side == TileSide::south ? glm::ivec2(along, last.y)
                                         : open.side == TileSide::east  ? glm::ivec2(last.x, along)
                                                                       : glm::ivec2(first.x, along);
                const bool is_new =
                    seams.emplace(Place{place.x, place.y, open.side}, Seam{tile, open.neighbour})
                        .second;
                EXPECT_TRUE(is_new);
            }
        }
    }
    return seams;
}

TEST(OpenSides, AreThoseBetweenDrawnTilesOnceAndThoseBesideUndrawnOnes) {
    test::Chance chance(11);
    int seams = 0;
    for (int round = 0; round < 2000; ++round) {
        const int cols = static_cast<int>(chance.between(2.0, 700.0));
        const int rows = static_cast<int>(chance.between(2.0, 700.0));
        const TileTree tree(cols, rows, {.around = chance.between(0.0, 1.0) < 0.3});
        std::vector<TreeTile> chosen;
        choose(tree, tree.root(), chance, chosen);
        const auto expected = expected_seams(tree, chosen);
        ASSERT_EQ(found_seams(tree, chosen), expected) << cols << ' ' << rows;
        seams += static_cast<int>(expected.size());
    }
    EXPECT_GT(seams, 10'000);
}

} // namespace
} // namespace reljef::view
