// The index of a raster that closes around the Earth.
#include <algorithm>
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "engine/io/index/column_runs.h"
#include "engine/io/index/index_pass.h"
#include "engine/io/index/indexed_tile.h"
#include "tests/io/made_raster.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"
#include "tests/terrain/made_globe.h"

namespace reljef::io {
namespace {

using terrain::TileTree;
using terrain::TreeTile;

struct StoredGlobe {
    test::MadeGlobe globe;
    GDALDataType type = GDT_Int16;
};

bool write(const StoredGlobe& stored, const std::filesystem::path& path) {
    const test::MadeGlobe& globe = stored.globe;
    test::MadeRaster raster =
        test::made_raster(globe.cols + (globe.repeats ? 1 : 0), globe.rows,
                          [&](int col, int row) { return globe.height(col % globe.cols, row); });
    raster.crs = "EPSG:4326";
    raster.geotransform = {globe.longitude(0) - 0.5 * globe.col_step(),
                           globe.col_step(),
                           0.0,
                           globe.latitude(0) + 0.5 * globe.row_step(),
                           0.0,
                           -globe.row_step()};
    raster.type = stored.type;
    return test::write(raster, path);
}

class GlobeIndex : public testing::TestWithParam<StoredGlobe> {
protected:
    void SetUp() override {
        RELJEF_RELEASE_ONLY("hundreds of thousands of samples by the lines of other tests");
        ASSERT_TRUE(write(GetParam(), path()));
        auto tiles = TileSet::open(path());
        ASSERT_TRUE(tiles) << tiles.error().message;
        const TileGrid grid = tiles->grid();
        auto source = index_source(std::move(*tiles), grid, Gaps::holes, folder_.path() / "cache");
        ASSERT_TRUE(source) << source.error().message;
        source_.emplace(std::move(*source));
        const auto made = make_index(*source_, {.threads = 2, .stop = {}, .progress = {}});
        ASSERT_TRUE(made) << made.error().message;
        auto index = ErrorIndex::open(*source_);
        ASSERT_TRUE(index && *index);
        index_.emplace(std::move(**index));
    }
    [[nodiscard]] std::filesystem::path path() const { return folder_.path() / "globe.tif"; }
    [[nodiscard]] const TileTree& tree() const { return source_->tree; }
    [[nodiscard]] std::vector<TreeTile> all_tiles() const {
        std::vector<TreeTile> tiles{tree().root()};
        for (std::size_t i = 0; i < tiles.size(); ++i) {
            const auto children = tree().children(tiles[i]);
            tiles.insert(tiles.end(), children.begin(), children.end());
        }
        return tiles;
    }
    [[nodiscard]] bool has_added_poles() const {
        return GetParam().globe.has_poles && !GetParam().globe.on_lines;
    }
    /// Of the closed raster.
    [[nodiscard]] float sample(int col, int row) const {
        const test::MadeGlobe& globe = GetParam().globe;
        const int turned = (col % globe.cols + globe.cols) % globe.cols;
        const int inside = std::clamp(row, 0, tree().rows() - 1) - (has_added_poles() ? 1 : 0);
        if (inside >= 0 && inside < globe.rows) {
            return static_cast<float>(globe.height(turned, inside));
        }
        double sum = 0.0;
        for (int i = 0; i < globe.cols; ++i) {
            sum += static_cast<float>(globe.height(i, inside < 0 ? 0 : globe.rows - 1));
        }
        return static_cast<float>(sum / globe.cols);
    }
    /// The samples that a tile's heights depend on, read without the index.
    [[nodiscard]] Grid<float> samples_of(TreeTile tile) const {
        const int border = terrain::sample_border(tile.level);
        const glm::ivec2 size = tree().cells(tile) * TileTree::step(tile) + 1 + 2 * border;
        const glm::ivec2 first = TileTree::first(tile) - border;
        Grid<float> samples(size.x, size.y);
        for (int row = 0; row < size.y; ++row) {
            const bool is_pole =
                has_added_poles() && (first.y + row <= 0 || first.y + row >= tree().rows() - 1);
            const float pole = is_pole ? sample(0, first.y + row) : 0.0F;
            for (int col = 0; col < size.x; ++col) {
                samples(col, row) = is_pole ? pole : sample(first.x + col, first.y + row);
            }
        }
        return samples;
    }
    [[nodiscard]] Grid<float> heights_of(TreeTile tile) const {
        const auto read = IndexedTiles(*source_, *index_).read(tile);
        EXPECT_TRUE(read && read->proof && read->errors.empty());
        return read ? read->heights : Grid<float>(1, 1);
    }

    void expect_one_height(TreeTile tile, int vertex_row, std::optional<float>& pole) const;

    test::TemporaryFolder folder_;
    std::optional<IndexSource> source_;
    std::optional<ErrorIndex> index_;
};

TEST_P(GlobeIndex, NoSampleContradictsIt) {
    EXPECT_TRUE(index_->is_complete());
    for (const TreeTile tile : all_tiles()) {
        const auto read = IndexedTiles(*source_, *index_).read(tile);
        ASSERT_TRUE(read && read->proof);
        ASSERT_TRUE(read->errors.empty()) << read->errors.front().message;
        const Grid<float> samples = samples_of(tile);
        ASSERT_EQ(read->heights, heights_from_samples(tree(), tile, samples))
            << tile.level << " " << tile.col << " " << tile.row;
        const auto check = check_proof(tree(), tile, *read->proof, read->heights, &samples);
        ASSERT_FALSE(check.contradiction) << *check.contradiction;
    }
}

void GlobeIndex::expect_one_height(TreeTile tile, int vertex_row,
                                   std::optional<float>& pole) const {
    const Grid<float> heights = heights_of(tile);
    pole = pole.value_or(heights(1, vertex_row + 1));
    for (int col = 0; col < heights.cols(); ++col) {
        ASSERT_EQ(heights(col, vertex_row + 1), *pole) << tile.level << " at " << col;
    }
}

// And one step beyond it on both sides.
TEST_P(GlobeIndex, TilesMeetAtTheSeamOnEveryLevel) {
    for (const TreeTile tile : all_tiles()) {
        if (tile.col > 0) {
            continue;
        }
        const TreeTile last{tile.level, level_tiles(tree(), tile.level).x - 1, tile.row};
        const Grid<float> heights = heights_of(tile);
        const Grid<float> beyond = heights_of(last);
        const int seam = tree().cells(last).x + 1;
        for (int row = 0; row < heights.rows(); ++row) {
            for (const int step : {-1, 0, 1}) {
                ASSERT_EQ(heights(1 + step, row), beyond(seam + step, row))
                    << tile.level << " " << step << " beyond the seam, row " << row;
            }
        }
    }
}

TEST_P(GlobeIndex, PolesHaveOneHeightOnAllLevels) {
    std::optional<float> north;
    std::optional<float> south;
    for (const TreeTile tile : all_tiles()) {
        if (GetParam().globe.has_poles && tile.row == 0) {
            expect_one_height(tile, 0, north);
        }
        if (GetParam().globe.has_poles && tile.row == level_tiles(tree(), tile.level).y - 1) {
            expect_one_height(tile, tree().cells(tile).y, south);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Globes, GlobeIndex,
    testing::Values(StoredGlobe{}, StoredGlobe{{}, GDT_Float64},
                    StoredGlobe{{.cols = 1026, .rows = 1100}, GDT_Float32},
                    StoredGlobe{{.cols = 1101, .rows = 90, .on_lines = true}},
                    StoredGlobe{{.cols = 2047, .rows = 60, .on_lines = true, .repeats = true}},
                    StoredGlobe{{.cols = 130, .rows = 40, .on_lines = true, .repeats = true}},
                    StoredGlobe{{.cols = 45, .rows = 700}},
                    StoredGlobe{{.cols = 1100, .rows = 66, .has_poles = false}}));

/// A raster over the whole Earth, and its index.
class IndexedGlobe {
public:
    explicit IndexedGlobe(test::MadeRaster raster) {
        raster.crs = "EPSG:4326";
        raster.geotransform = {-180.0, 360.0 / raster.cols, 0.0, 90.0, 0.0, -180.0 / raster.rows};
        raster.nodata = -9999.0;
        EXPECT_TRUE(test::write(raster, folder_.path() / "globe.tif"));
        auto tiles = TileSet::open(folder_.path() / "globe.tif");
        EXPECT_TRUE(tiles);
        const TileGrid grid = tiles->grid();
        auto source = index_source(std::move(*tiles), grid, Gaps::holes, folder_.path());
        EXPECT_TRUE(source && make_index(*source, {}));
        source_.emplace(std::move(*source));
        auto index = ErrorIndex::open(*source_);
        EXPECT_TRUE(index && *index);
        index_.emplace(std::move(**index));
    }
    [[nodiscard]] const IndexSource& source() const { return *source_; }
    [[nodiscard]] bool has_voids(TreeTile tile) const { return index_->find(tile)->has_voids; }
    void expect_no_contradiction(TreeTile tile) const {
        const auto read = IndexedTiles(*source_, *index_).read(tile);
        ASSERT_TRUE(read);
        EXPECT_TRUE(read->errors.empty()) << read->errors.front().message;
    }

private:
    test::TemporaryFolder folder_;
    std::optional<IndexSource> source_;
    std::optional<ErrorIndex> index_;
};

TEST(GlobeIndexWithVoids, HasAVoidAtThePoleBesideARowOfVoids) {
    const IndexedGlobe globe(test::made_raster(
        180, 90, [](int col, int row) { return row == 0 ? -9999.0 : 10.0 * row + col % 7; }));
    EXPECT_TRUE(std::isnan(globe.source().north_height));
    EXPECT_FALSE(std::isnan(globe.source().south_height));
    EXPECT_TRUE(globe.has_voids({0, 1, 0}));
    EXPECT_FALSE(globe.has_voids({0, 1, 1}));
}

TEST(GlobeIndexWithVoids, AVoidPoleAmongVoidsContradictsNoProof) {
    const IndexedGlobe globe(test::made_raster(360, 82, [](int col, int row) {
        return row >= 68 ? -9999.0 : 500.0 + 10.0 * row + col % 7; // 0 at the pole is below it
    }));
    globe.expect_no_contradiction({3, 0, 0});
}

// 137 cells around at level 3: the last one of level 4 is half as wide as the others.
TEST(GlobeIndexAtTheSeam, GroundBeyondAShortCellContradictsNoProof) {
    const IndexedGlobe globe(test::made_raster(
        1096, 200, [](int col, int /*row*/) { return col > 0 && col < 16 ? 100.0 : 0.0; }));
    globe.expect_no_contradiction({4, 1, 0});
}

TEST(ColumnRuns, RepeatNothingWithoutATurn) {
    const auto runs = column_runs(-5, 20, {10, 0});
    ASSERT_EQ(runs.size(), 1U);
    EXPECT_EQ(runs[0].at, 5);
    EXPECT_EQ(runs[0].first, 0);
    EXPECT_EQ(runs[0].count, 10);
}

TEST(ColumnRuns, HaveTheColumnOfEveryPlaceOfATurn) {
    for (const int repeated : {0, 1}) {
        for (int around = 1; around < 8; ++around) {
            for (int first = -20; first < 20; ++first) {
                int next = 0;
                for (const ColumnRun& run : column_runs(first, 40, {around + repeated, around})) {
                    ASSERT_EQ(run.at, next);
                    ASSERT_GE(run.first, 0);
                    ASSERT_LE(run.first + run.count, around + repeated);
                    ASSERT_EQ((first + run.at - run.first) % around, 0);
                    next += run.count;
                }
                ASSERT_EQ(next, 40);
            }
        }
    }
}

} // namespace
} // namespace reljef::io
