#include "engine/view/tile_gaps.h"

#include <vector>

#include <gtest/gtest.h>

namespace reljef::view {
namespace {

using terrain::TileTree;
using terrain::TreeTile;

scene::TileSummary proven(TreeTile id, double error) {
    scene::TileSummary tile;
    tile.id = id;
    tile.error = error;
    tile.range = {100.0, 150.0};
    tile.is_proven = true;
    return tile;
}

std::map<TreeTile, double> gaps_of(const TileTree& tree,
                                   const std::vector<scene::TileSummary>& tiles,
                                   double exaggeration = 1.0) {
    std::vector<const scene::TileSummary*> pointers;
    for (const scene::TileSummary& tile : tiles) {
        pointers.push_back(&tile);
    }
    return tile_gaps(tree, pointers, exaggeration);
}

// 4×4 tiles at level 0.
constexpr int side = 4 * terrain::tree_tile_cells + 1;

TEST(TileGaps, JoinTheErrorsOfNeighboursOnBothSides) {
    const auto gaps = gaps_of(TileTree(side, side), {proven({0, 0, 0}, 1.0), proven({0, 1, 0}, 4.0),
                                                     proven({0, 0, 1}, 2.0)});
    EXPECT_EQ(gaps.at({0, 0, 0}), 5.0);
    EXPECT_EQ(gaps.at({0, 1, 0}), 5.0);
    EXPECT_EQ(gaps.at({0, 0, 1}), 3.0);
}

TEST(TileGaps, OfACoarseTileCountAllFinerOnesBesideIt) {
    const auto gaps =
        gaps_of(TileTree(side, side),
                {proven({1, 0, 0}, 10.0), proven({0, 2, 0}, 0.5), proven({0, 2, 1}, 20.0)});
    EXPECT_EQ(gaps.at({1, 0, 0}), 30.0);
    EXPECT_EQ(gaps.at({0, 2, 0}), 20.5);
    EXPECT_EQ(gaps.at({0, 2, 1}), 30.0);
}

TEST(TileGaps, AreNoneWithoutNeighbours) {
    EXPECT_TRUE(
        gaps_of(TileTree(side, side), {proven({0, 0, 0}, 1.0), proven({0, 1, 1}, 1.0)}).empty());
    EXPECT_TRUE(
        gaps_of(TileTree(side, side), {proven({0, 0, 0}, 1.0), proven({0, 3, 0}, 1.0)}).empty());
}

TEST(TileGaps, GoAcrossTheAntimeridian) {
    const auto gaps =
        gaps_of(TileTree(side, side, true), {proven({0, 0, 0}, 1.0), proven({0, 3, 0}, 2.0)});
    EXPECT_EQ(gaps.at({0, 0, 0}), 3.0);
    EXPECT_EQ(gaps.at({0, 3, 0}), 3.0);
}

// A tower of 50 m beside flat ground: seen from above, the gap is many pixels' height deep.
TEST(TileGaps, AreAsDeepAsVoidsAndUnprovenTilesMayBe) {
    scene::TileSummary voids = proven({0, 0, 0}, 1.0);
    voids.has_voids = true;
    scene::TileSummary unproven = proven({0, 1, 0}, 1.0);
    unproven.is_proven = false;
    const auto gaps = gaps_of(TileTree(side, side), {voids, unproven, proven({0, 2, 0}, 3.0)}, 2.0);
    EXPECT_EQ(gaps.at({0, 0, 0}), 2.0 * 50.0 + 16.0);
    EXPECT_EQ(gaps.at({0, 2, 0}), 16.0 + 3.0);
}

} // namespace
} // namespace reljef::view
