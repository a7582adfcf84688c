#include "engine/session/proven_tiles.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <glm/common.hpp>
#include <gtest/gtest.h>

#include "engine/io/index/index_pass.h"
#include "engine/io/tree_tile.h"
#include "tests/session/made_waves.h"
#include "tests/support/temporary_folder.h"

namespace reljef::session {
namespace {

constexpr int refinement = 4;

/// 700×520 samples, and a tree that is finer than they are.
class RefinedTree : public testing::Test {
protected:
    void SetUp() override {
        test::write_waves(folder_.path() / "waves.tif", 700, 520);
        auto tiles = io::TileSet::open(folder_.path() / "waves.tif");
        ASSERT_TRUE(tiles) << tiles.error().message;
        auto source =
            io::index_source(*tiles, tiles->grid(), io::Gaps::holes, folder_.path() / "cache");
        ASSERT_TRUE(source) << source.error().message;
        source_ = *source;
        ASSERT_TRUE(io::make_index(*source_, {}));
        auto index = io::ErrorIndex::open(*source_);
        ASSERT_TRUE(index && *index);
        proofs_ = std::make_unique<const ProvenTiles>(*source, std::move(**index), refinement);
        ground_ = io::wrapped_grid(source_->grid, {}, refinement);
    }
    [[nodiscard]] terrain::TileTree tree() const { return {ground_.grid.cols, ground_.grid.rows}; }
    /// All tiles above the samples, and a part of those below.
    [[nodiscard]] std::vector<terrain::TreeTile> some_tiles() const {
        std::vector<terrain::TreeTile> tiles{tree().root()};
        for (std::size_t i = 0; i < tiles.size(); ++i) {
            const auto children = tree().children(tiles[i]);
            tiles.insert(tiles.end(), children.begin(), children.end());
        }
        std::erase_if(tiles, [&](terrain::TreeTile tile) {
            const bool is_at_end = terrain::TileTree::first(tile).x +
                                       terrain::tree_tile_cells * terrain::TileTree::step(tile) >=
                                   tree().cols();
            return tile.level < 2 && !is_at_end && (tile.col + tile.row) % 7 != 0 &&
                   (tile.col / 4 + tile.row / 4) > 2;
        });
        return tiles;
    }

    test::TemporaryFolder folder_;
    std::optional<io::IndexSource> source_;
    std::unique_ptr<const ProvenTiles> proofs_;
    io::WrappedGrid ground_;
};

// Within two vertices. `voids`: 1: a void; empty: none.
bool is_near_void(const Grid<std::uint8_t>& voids, glm::ivec2 vertex) {
    constexpr int reach = 2;
    for (int row = vertex.y - reach; row <= vertex.y + reach && !voids.empty(); ++row) {
        for (int col = vertex.x - reach; col <= vertex.x + reach; ++col) {
            if (voids.clamped(col, row) != 0) {
                return true;
            }
        }
    }
    return false;
}

/// Height of a tile's surface at a sample of its tree.
double surface_of(const terrain::TileTree& tree, terrain::TreeTile tile, const Grid<float>& heights,
                  glm::ivec2 sample) {
    const glm::ivec2 cell =
        glm::min((sample - terrain::TileTree::first(tile)) / terrain::TileTree::step(tile),
                 tree.cells(tile) - 1);
    const glm::dvec2 low(tree.sample(tile, cell));
    const glm::dvec2 share =
        (glm::dvec2(sample) - low) / (glm::dvec2(tree.sample(tile, cell + 1)) - low);
    const auto at = [&](int col, int row) {
        return static_cast<double>(heights(cell.x + 1 + col, cell.y + 1 + row));
    };
    return glm::mix(glm::mix(at(0, 0), at(1, 0), share.x), glm::mix(at(0, 1), at(1, 1), share.x),
                    share.y);
}

TEST_F(RefinedTree, NoSampleIsFartherFromATileThanItsProofSays) {
    constexpr double rounding = 1e-3; // metres: heights below 2^11 m are floats
    for (const terrain::TreeTile tile : some_tiles()) {
        const auto proof = proofs_->find(tile);
        const auto content = proofs_->read(tile, {});
        ASSERT_TRUE(proof && content) << tile.level << " " << tile.col << " " << tile.row;
        EXPECT_TRUE(content->is_proven);
        EXPECT_TRUE(tile.level > 2 || proof->error == 0.0F);
        const glm::ivec2 last = tree().sample(tile, tree().cells(tile));
        double worst = 0.0;
        for (int row = terrain::TileTree::first(tile).y; row <= last.y; row += refinement) {
            for (int col = terrain::TileTree::first(tile).x; col <= last.x; col += refinement) {
                const glm::ivec2 sample = glm::ivec2(col, row) / refinement;
                const double height = test::height_of_waves(sample.x, sample.y);
                if (sample != glm::ivec2(100, 70)) {
                    EXPECT_TRUE(proof->low <= height && height <= proof->high);
                    const double found = surface_of(tree(), tile, content->heights, {col, row});
                    worst = std::isnan(found) ? worst : std::max(worst, std::abs(height - found));
                }
            }
        }
        EXPECT_LE(worst, proof->error + rounding)
            << tile.level << " " << tile.col << " " << tile.row;
    }
}

TEST_F(RefinedTree, TilesBelowTheSamplesAreThoseReadWithoutAnIndex) {
    int voids = 0;
    for (const terrain::TreeTile tile : some_tiles()) {
        if (tile.level >= 2) {
            continue;
        }
        const auto content = proofs_->read(tile, {});
        const auto plain =
            io::read_tree_tile(source_->tiles, ground_, tree(), tile, io::Gaps::holes);
        ASSERT_TRUE(content);
        ASSERT_EQ(content->heights.cols(), plain.heights.cols());
        ASSERT_EQ(content->heights.rows(), plain.heights.rows());
        double worst = 0.0;
        for (int row = 0; row < plain.heights.rows(); ++row) {
            for (int col = 0; col < plain.heights.cols(); ++col) {
                const double found = content->heights(col, row);
                const double expected = plain.heights(col, row);
                const bool was_void =
                    !content->was_void.empty() && content->was_void(col, row) != 0;
                voids += was_void ? 1 : 0;
                EXPECT_TRUE(std::isfinite(found));
                EXPECT_EQ(was_void, std::isnan(expected)) << tile.level << " " << tile.col << " "
                                                          << tile.row << ": " << col << " " << row;
                if (!is_near_void(content->was_void, {col, row})) { // there, fills differ
                    worst = std::max(worst, std::abs(found - expected));
                }
            }
        }
        EXPECT_LT(worst, 1e-3) << tile.level << " " << tile.col << " " << tile.row;
    }
    EXPECT_GT(voids, 0);
}

} // namespace
} // namespace reljef::session
