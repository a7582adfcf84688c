#include "engine/io/index/indexed_tile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/io/index/index_pass.h"
#include "tests/io/made_raster.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"
#include "tests/terrain/chance.h"

namespace reljef::io {
namespace {

using terrain::TileProof;
using terrain::TileTree;
using terrain::TreeTile;

/// What an index says of all tiles of a terrain with voids, compared with the tiles of all samples.
class FilledTiles {
public:
    explicit FilledTiles(const std::filesystem::path& path) : cache_(), source_(opened(path)) {
        EXPECT_TRUE(make_index(source_, {}));
        auto index = ErrorIndex::open(source_);
        EXPECT_TRUE(index && *index && (*index)->is_complete());
        index_ = std::move(*index);
        const TileTree& tree = source_.tree;
        surface_ = Grid<float>(tree.cols(), tree.rows(), std::numeric_limits<float>::quiet_NaN());
        std::vector<TreeTile> tiles{tree.root()};
        for (std::size_t i = 0; i < tiles.size(); ++i) {
            const auto children = tree.children(tiles[i]);
            tiles.insert(tiles.end(), children.begin(), children.end());
        }
        std::reverse(tiles.begin(), tiles.end()); // the finest first
        for (const TreeTile tile : tiles) {
            SCOPED_TRACE(fmt::format("tile {},{} of level {}", tile.col, tile.row, tile.level));
            expect_proven(tile);
        }
    }
    [[nodiscard]] std::size_t voids() const { return voids_; }

private:
    IndexSource opened(const std::filesystem::path& path) const {
        auto tiles = TileSet::open(path);
        EXPECT_TRUE(tiles) << tiles.error().message;
        const TileGrid grid = tiles->grid();
        return *index_source(std::move(*tiles), grid, Gaps::holes, cache_.path());
    }

    void expect_proven(TreeTile tile) {
        const auto read = IndexedTiles(source_, *index_).read(tile);
        ASSERT_TRUE(read && read->proof && read->errors.empty());
        const auto proof = IndexedTiles(source_, *index_).proof(tile);
        ASSERT_TRUE(proof);
        if (tile.level == 0) {
            join(tile, *read);
        }
        const glm::ivec2 first = TileTree::first(tile);
        const glm::ivec2 last = source_.tree.sample(tile, source_.tree.cells(tile));
        int over = 0;
        int over_parts = 0;
        for (int row = first.y; row <= last.y; ++row) {
            for (int col = first.x; col <= last.x; ++col) {
                const float height = surface_(col, row);
                ASSERT_GE(height, proof->low);
                ASSERT_LE(height, proof->high);
                const double error = std::abs(height - height_in(tile, read->heights, {col, row}));
                const glm::ivec2 cell = glm::min((glm::ivec2(col, row) - first) >> tile.level,
                                                 source_.tree.cells(tile) - 1);
                const glm::ivec2 part = cell / terrain::cells_per_error_part;
                const double of_part = read->parts.at(static_cast<std::size_t>(
                                           part.y * terrain::error_parts + part.x)) /
                                       255.0 * proof->error;
                over += error <= proof->block_error(terrain::block_at(cell)) ? 0 : 1;
                over_parts += error <= of_part ? 0 : 1;
            }
        }
        EXPECT_EQ(over, 0) << proof->error << " m stated";
        EXPECT_EQ(over_parts, 0) << proof->error << " m stated";
    }

    /// Adds a tile of all samples; its borders are those of its neighbours.
    void join(TreeTile tile, const IndexedTile& read) {
        const glm::ivec2 first = TileTree::first(tile);
        for (int row = 0; row <= source_.tree.cells(tile).y; ++row) {
            for (int col = 0; col <= source_.tree.cells(tile).x; ++col) {
                float& joined = surface_(first.x + col, first.y + row);
                const float height = read.heights(col + 1, row + 1);
                ASSERT_TRUE(std::isfinite(height));
                ASSERT_TRUE(std::isnan(joined) || joined == height) << col << "," << row;
                joined = height;
                voids_ += !read.was_void.empty() && read.was_void(col + 1, row + 1) != 0 ? 1U : 0U;
            }
        }
    }

    [[nodiscard]] double height_in(TreeTile tile, const Grid<float>& heights,
                                   glm::ivec2 sample) const {
        const TileTree& tree = source_.tree;
        const glm::ivec2 cell =
            glm::min((sample - TileTree::first(tile)) >> tile.level, tree.cells(tile) - 1);
        const glm::dvec2 low(tree.sample(tile, cell));
        const glm::dvec2 share =
            (glm::dvec2(sample) - low) / (glm::dvec2(tree.sample(tile, cell + 1)) - low);
        const auto at = [&](int col, int row) {
            return double{heights(cell.x + 1 + col, cell.y + 1 + row)};
        };
        return glm::mix(glm::mix(at(0, 0), at(1, 0), share.x),
                        glm::mix(at(0, 1), at(1, 1), share.x), share.y);
    }

    test::TemporaryFolder cache_;
    IndexSource source_;
    std::optional<ErrorIndex> index_;
    Grid<float> surface_; // of the tiles of all samples
    std::size_t voids_ = 0;
};

/// Hills with voids: single samples, and rectangles of all sizes.
test::MadeRaster raster_with_voids(test::Chance& chance, glm::ivec2 size) {
    const double wave = chance.between(0.005, 0.3);
    const double rough = std::exp(chance.between(-3.0, 5.0));
    auto raster = test::made_raster(size.x, size.y, [&](int col, int row) {
        return 900.0 + 700.0 * std::sin(wave * col) * std::cos(0.7 * wave * row) +
               chance.between(-rough, rough);
    });
    raster.crs = "EPSG:32631";
    raster.geotransform = {300000.0, 10.0, 0.0, 5600000.0, 0.0, -10.0};
    raster.type = GDT_Float32;
    raster.nodata = -9999.0;
    const auto cut = [&](glm::ivec2 extent) {
        const glm::ivec2 first(chance.whole(0, size.x - extent.x),
                               chance.whole(0, size.y - extent.y));
        for (int row = first.y; row < first.y + extent.y; ++row) {
            for (int col = first.x; col < first.x + extent.x; ++col) {
                raster.values[static_cast<std::size_t>(row) * static_cast<std::size_t>(size.x) +
                              static_cast<std::size_t>(col)] = -9999.0;
            }
        }
    };
    for (int n = chance.whole(0, 40); n > 0; --n) {
        cut({1, 1});
    }
    for (int n = chance.whole(1, 6); n > 0; --n) {
        const double share = std::exp(chance.between(-6.0, 0.0));
        cut(glm::max(glm::ivec2(share * glm::dvec2(size)) - chance.whole(0, 1), glm::ivec2(1)));
    }
    return raster;
}

TEST(IndexedTiles, ErrorsHoldWhereVoidsAreFilledAtEachLevel) {
    RELJEF_RELEASE_ONLY("all samples of dozens of terrains by the lines of the next test");
    test::Chance chance(61);
    std::size_t voids = 0;
    for (int n = 0; n < test::rounds(60, 12); ++n) {
        SCOPED_TRACE(n);
        const test::TemporaryFolder folder;
        const glm::ivec2 size(chance.whole(2, n % 10 == 0 ? 1300 : 400), chance.whole(2, 400));
        ASSERT_TRUE(test::write(raster_with_voids(chance, size), folder.path() / "dem.tif"));
        voids += FilledTiles(folder.path() / "dem.tif").voids();
        if (HasFailure()) {
            return;
        }
    }
    EXPECT_GT(voids, 100'000U);
}

TEST(IndexedTiles, ErrorsHoldWhereARealTerrainHasVoids) {
    RELJEF_RELEASE_ONLY("all samples of a degree");
    for (const char* const name : {"natural/srtm3/N49E001.hgt", "natural/mt_rainier_90m.tif"}) {
        RELJEF_NEED_DATA(name);
        SCOPED_TRACE(name);
        EXPECT_GT(FilledTiles(test::data_path(name)).voids(), 5'000U);
    }
}

} // namespace
} // namespace reljef::io
