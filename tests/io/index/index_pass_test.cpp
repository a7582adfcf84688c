#include "engine/io/index/index_pass.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/index/indexed_tile.h"
#include "engine/io/raster/gdal_dataset.h"
#include "tests/io/made_raster.h"
#include "tests/support/plain_permissions.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

namespace fs = std::filesystem;
using terrain::TileProof;
using terrain::TileTree;
using terrain::TreeTile;
using testing::HasSubstr;

constexpr int cols = 2300;
constexpr int rows = 1200;

const Grid<float>& wavy_heights() {
    static const Grid<float> made = [] {
        Grid<float> heights(cols, rows);
        for (int row = 0; row < rows; ++row) {
            for (int col = 0; col < cols; ++col) {
                heights(col, row) = static_cast<float>(
                    std::round(900.0 + 700.0 * std::sin(0.013 * col) * std::cos(0.021 * row) +
                               40.0 * std::sin(0.9 * col + 0.4 * row)));
            }
        }
        return heights;
    }();
    return made;
}

test::MadeRaster wavy_raster(GDALDataType type) {
    auto raster =
        test::made_raster(cols, rows, [](int col, int row) { return wavy_heights()(col, row); });
    raster.crs = "EPSG:32631";
    raster.geotransform = {300000.0, 10.0, 0.0, 5600000.0, 0.0, -10.0};
    raster.type = type;
    raster.options = {"TILED=YES", "COMPRESS=DEFLATE", "ZLEVEL=1"};
    return raster;
}

/// A raster of 3×2 chunks and five levels, and the folder of its index.
class IndexPass : public testing::Test {
protected:
    static void SetUpTestSuite() {
        made_ = std::make_unique<test::TemporaryFolder>();
        ASSERT_TRUE(test::write(wavy_raster(GDT_Int16), made_->path() / "dem.tif"));
    }
    static void TearDownTestSuite() { made_.reset(); }
    void SetUp() override { fs::copy_file(made_->path() / "dem.tif", raster()); }

    [[nodiscard]] fs::path raster() const { return folder_.path() / "dem.tif"; }
    [[nodiscard]] fs::path cache() const { return folder_.path() / "cache"; }
    [[nodiscard]] IndexSource source() const { return source_at(raster()); }
    [[nodiscard]] IndexSource source_at(const fs::path& path) const {
        auto tiles = TileSet::open(path);
        EXPECT_TRUE(tiles) << tiles.error().message;
        const TileGrid grid = tiles->grid();
        auto source = index_source(std::move(*tiles), grid, Gaps::holes, cache());
        EXPECT_TRUE(source) << source.error().message;
        return std::move(*source);
    }
    /// Overwrites some of the raster's bytes; its size and time remain.
    void damage(std::string& bytes, std::streamoff place) const {
        const auto time = fs::last_write_time(raster());
        {
            std::fstream file(raster(), std::ios::in | std::ios::out | std::ios::binary);
            std::string before(bytes.size(), '\0');
            file.seekg(place);
            file.read(before.data(), static_cast<std::streamsize>(before.size()));
            file.seekp(place);
            file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
            bytes = before;
        }
        fs::last_write_time(raster(), time);
    }

    [[nodiscard]] std::streamoff place_of_block(const char* name) const {
        const auto dataset = open_raster(raster(), GdalMessages());
        EXPECT_TRUE(dataset);
        return std::stoll((*dataset)->GetRasterBand(1)->GetMetadataItem(name, "TIFF"));
    }

private:
    inline static std::unique_ptr<test::TemporaryFolder> made_;
    test::TemporaryFolder folder_;
};

std::vector<TreeTile> all_tiles(const TileTree& tree) {
    std::vector<TreeTile> tiles{tree.root()};
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        const auto children = tree.children(tiles[i]);
        tiles.insert(tiles.end(), children.begin(), children.end());
    }
    return tiles;
}

/// The samples that a tile's heights depend on, read without the index.
Grid<float> samples_of(TreeTile tile, const TileTree& tree) {
    const int border = terrain::sample_border(tile.level);
    const glm::ivec2 size = tree.cells(tile) * TileTree::step(tile) + 1 + 2 * border;
    const glm::ivec2 first = TileTree::first(tile) - border;
    Grid<float> samples(size.x, size.y);
    for (int row = 0; row < size.y; ++row) {
        for (int col = 0; col < size.x; ++col) {
            samples(col, row) = wavy_heights().clamped(first.x + col, first.y + row);
        }
    }
    return samples;
}

std::vector<TileProof> proofs_of(const IndexSource& source) {
    std::vector<TileProof> proofs;
    const auto index = ErrorIndex::open(source);
    for (const TreeTile tile : all_tiles(source.tree)) {
        proofs.push_back((*index)->find(tile).value_or(TileProof{}));
    }
    return proofs;
}

/// All tiles are proven.
void expect_complete(const IndexSource& source) {
    const auto index = ErrorIndex::open(source);
    ASSERT_TRUE(index && *index);
    EXPECT_TRUE((*index)->is_complete());
    for (const TreeTile tile : all_tiles(source.tree)) {
        EXPECT_TRUE((*index)->find(tile)) << tile.level << " " << tile.col << " " << tile.row;
        if (tile.level >= ErrorIndex::first_stored_level) {
            const auto read = IndexedTiles(source, **index).read(tile);
            ASSERT_TRUE(read && read->proof && read->errors.empty());
        }
    }
}

TEST_F(IndexPass, ProvesAllTilesAndTakesLittle) {
    const IndexSource terrain = source();
    const auto report = make_index(terrain, {});
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_LE(static_cast<double>(report->bytes_of_proofs), 0.005 * 2.0 * cols * rows);
    EXPECT_EQ(report->levels.size(), 7U);
    for (const auto& level : report->levels) {
        EXPECT_EQ(level.unproven, 0U);
    }
    expect_complete(terrain);
}

// The share of a large raster: fewer of its tiles are cut.
TEST_F(IndexPass, OfBytesTakesLittle) {
    constexpr int side = 2049;
    test::MadeRaster bytes = test::made_raster(
        side, side, [](int col, int row) { return (col / 7 + row / 5 + col * row / 900) % 256; });
    bytes.crs = "EPSG:32631";
    bytes.geotransform = {300000.0, 10.0, 0.0, 5600000.0, 0.0, -10.0};
    bytes.type = GDT_Byte;
    fs::remove(raster());
    ASSERT_TRUE(test::write(bytes, raster()));
    const IndexSource terrain = source();
    const auto report = make_index(terrain, {});
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_LE(static_cast<double>(report->bytes_of_proofs), 0.005 * side * side);
    expect_complete(terrain);
}

TEST_F(IndexPass, RoundsTheRangesOfFloatsOutwardsByLessThanAStep) {
    test::MadeRaster floats = wavy_raster(GDT_Float32);
    for (double& height : floats.values) {
        height = static_cast<float>(0.37 * height - 101.123);
    }
    fs::remove(raster());
    ASSERT_TRUE(test::write(floats, raster()));
    const IndexSource terrain = source();
    ASSERT_TRUE(make_index(terrain, {}));
    const auto index = ErrorIndex::open(terrain);
    ASSERT_TRUE(index && *index);
    for (const TreeTile tile : all_tiles(terrain.tree)) {
        const auto proof = (*index)->find(tile);
        ASSERT_TRUE(proof);
        std::pair range{1e9, -1e9};
        const glm::ivec2 last = terrain.tree.sample(tile, terrain.tree.cells(tile));
        for (int row = TileTree::first(tile).y; row <= last.y; ++row) {
            for (int col = TileTree::first(tile).x; col <= last.x; ++col) {
                const double height = floats.values[static_cast<std::size_t>(row) * cols +
                                                    static_cast<std::size_t>(col)];
                range = {std::min(range.first, height), std::max(range.second, height)};
            }
        }
        EXPECT_LE(proof->low, range.first);
        EXPECT_GE(proof->high, range.second);
        EXPECT_LT(range.first - proof->low, proof->range_step);
        EXPECT_LT(proof->high - range.second, proof->range_step);
        EXPECT_LE(proof->range_step, 0.04); // of 700 m of relief
    }
}

TEST_F(IndexPass, NoSampleContradictsIt) {
    RELJEF_RELEASE_ONLY("all samples of many tiles by the lines of the other tests");
    const IndexSource terrain = source();
    ASSERT_TRUE(make_index(terrain, {}));
    const auto index = ErrorIndex::open(terrain);
    ASSERT_TRUE(index && *index);
    for (const TreeTile tile : all_tiles(terrain.tree)) {
        if (tile.level < 3 && (tile.col + tile.row) % 5 != 0) {
            continue;
        }
        const auto read = IndexedTiles(terrain, **index).read(tile);
        ASSERT_TRUE(read && read->proof);
        EXPECT_TRUE(read->errors.empty()) << read->errors.front().message;
        const Grid<float> samples = samples_of(tile, terrain.tree);
        EXPECT_EQ(read->heights, heights_from_samples(terrain.tree, tile, samples));
        const terrain::ProofCheck check =
            check_proof(terrain.tree, tile, *read->proof, read->heights, &samples);
        EXPECT_FALSE(check.contradiction) << *check.contradiction;
        for (std::size_t i = 0; i < read->parts.size(); ++i) {
            constexpr int rounding = 2; // up twice: the share, and its division
            EXPECT_GE(read->parts.at(i) + rounding, check.parts->at(i)) << tile.level << " " << i;
        }
    }
}

TEST_F(IndexPass, ReadsValuesOfAllTypesAlike) {
    ASSERT_TRUE(make_index(source(), {}));
    const auto of_whole_numbers = proofs_of(source());
    fs::remove(raster());
    ASSERT_TRUE(test::write(wavy_raster(GDT_Float32), raster()));
    ASSERT_TRUE(make_index(source(), {}));
    EXPECT_EQ(of_whole_numbers, proofs_of(source()));
}

TEST_F(IndexPass, FindsTheVoidsOfFloatsThatAreReadAsTheyAreStored) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    for (const std::optional<double> declared : {std::optional(-9999.0), std::optional<double>()}) {
        std::vector<std::vector<TileProof>> found;
        for (const GDALDataType type : {GDT_Float32, GDT_Float64}) { // the latter by decode()
            test::MadeRaster made = wavy_raster(type);
            const std::array odd{-9999.0,   -32768.0,     -32767.0, infinite,
                                 -infinite, std::nan(""), 2e8,      -2e8};
            for (std::size_t i = 0; i < odd.size(); ++i) {
                made.values[i * 70'001] = odd.at(i);
            }
            made.nodata = declared;
            fs::remove(raster());
            ASSERT_TRUE(test::write(made, raster()));
            ASSERT_TRUE(make_index(source(), {}));
            found.push_back(proofs_of(source()));
        }
        EXPECT_EQ(found[0], found[1]);
        EXPECT_TRUE(found[0].front().has_voids);
    }
}

TEST_F(IndexPass, StopsAndGoesOnWhereItStopped) {
    const IndexSource terrain = source();
    std::stop_source stop;
    const auto stopped = make_index(
        terrain, {.threads = 1, .stop = stop.get_token(), .progress = [&](double fraction) {
                      if (fraction > 0.4) {
                          stop.request_stop();
                      }
                  }});
    ASSERT_FALSE(stopped);
    EXPECT_THAT(stopped.error().message, HasSubstr("interrupted"));
    int chunks = 0;
    const auto report =
        make_index(terrain, {.threads = 1, .stop = {}, .progress = [&](double) { ++chunks; }});
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(chunks, 3); // of six
    expect_complete(terrain);
    chunks = 0;
    ASSERT_TRUE(
        make_index(terrain, {.threads = 1, .stop = {}, .progress = [&](double) { ++chunks; }}));
    EXPECT_EQ(chunks, 0);
}

TEST_F(IndexPass, KeepsNothingOfASourceThatChangesMeanwhile) {
    const IndexSource terrain = source();
    const auto report =
        make_index(terrain, {.threads = 1, .stop = {}, .progress = [&](double) {
                                 fs::last_write_time(raster(), fs::file_time_type::clock::now() +
                                                                   std::chrono::hours(1));
                             }});
    ASSERT_FALSE(report);
    EXPECT_THAT(report.error().message, HasSubstr("changed while it was indexed"));
    EXPECT_FALSE(fs::exists(terrain.file));
}

TEST_F(IndexPass, UsesNoIndexOfAnotherStateOfTheSource) {
    ASSERT_TRUE(make_index(source(), {}));
    const auto changed = fs::last_write_time(raster()) + std::chrono::hours(1);
    fs::last_write_time(raster(), changed);
    const IndexSource terrain = source();
    const auto index = ErrorIndex::open(terrain);
    ASSERT_FALSE(index);
    EXPECT_THAT(index.error().message, HasSubstr("present state of"));
    ASSERT_TRUE(make_index(terrain, {}));
    expect_complete(terrain);
}

TEST_F(IndexPass, FindsNonsenseBehindValidChecksums) {
    const IndexSource terrain = source();
    ASSERT_TRUE(make_index(terrain, {}));
    for (const int level : {0, 1, 2, 3}) {
        const TreeTile tile{level, 0, 0};
        const Grid<float> heights =
            heights_from_samples(terrain.tree, tile, samples_of(tile, terrain.tree));
        const auto index = ErrorIndex::open(terrain);
        const TileProof right = *(*index)->find(tile);
        const auto wrong = [&](TileProof proof) {
            return check_proof(terrain.tree, tile, proof, heights).contradiction.has_value();
        };
        EXPECT_FALSE(wrong(right));
        EXPECT_TRUE(wrong({right.low + 500.0F, right.high, right.error}));
        EXPECT_TRUE(wrong({right.low, right.high - 500.0F, right.error}));
        EXPECT_TRUE(wrong({right.high, right.low, right.error}));
        EXPECT_TRUE(wrong({right.low, right.high, -1.0F}));
        EXPECT_TRUE(wrong({right.low, right.high, std::nanf("")}));
        EXPECT_EQ(wrong({right.low, right.high, right.error, !right.has_voids}), level == 0);
    }
    auto index = ErrorIndex::open_to_write(terrain);
    ASSERT_TRUE(index);
    terrain::ChunkProof nonsense = terrain::prove_chunk(
        terrain.tree, {0, 0, 0},
        {[](int, std::span<float> heights) { std::fill(heights.begin(), heights.end(), 5.0F); }});
    ASSERT_TRUE(index->write({0, 0, 0}, nonsense));
    for (const int level : {0, 1, 2}) {
        const auto read = IndexedTiles(terrain, *index).read({level, 0, 0});
        ASSERT_TRUE(read);
        EXPECT_FALSE(read->proof);
        ASSERT_EQ(read->errors.size(), 1U);
        EXPECT_THAT(read->errors.front().message, HasSubstr("was expected"));
    }
}

TEST_F(IndexPass, FindsErrorsOfPartsThatAreNotThoseOfTheBlocks) {
    const IndexSource terrain = source();
    ASSERT_TRUE(make_index(terrain, {}));
    auto index = ErrorIndex::open_to_write(terrain);
    ASSERT_TRUE(index);
    terrain::ChunkProof proof = terrain::prove_chunk(
        terrain.tree, {0, 0, 0}, {[](int row, std::span<float> heights) {
            for (std::size_t i = 0; i < heights.size(); ++i) {
                heights[i] = wavy_heights().clamped(static_cast<int>(i) - terrain::chunk_border,
                                                    row - terrain::chunk_border);
            }
        }});
    const TreeTile tile{ErrorIndex::first_stored_level, 0, 0};
    ASSERT_TRUE(index->write({0, 0, 0}, proof));
    EXPECT_TRUE(IndexedTiles(terrain, *index).read(tile)->proof);
    proof.levels.back().parts(0, 0).fill(0);
    ASSERT_TRUE(index->write({0, 0, 0}, proof));
    const auto read = IndexedTiles(terrain, *index).read(tile);
    ASSERT_TRUE(read);
    EXPECT_FALSE(read->proof);
    ASSERT_EQ(read->errors.size(), 1U);
    EXPECT_THAT(read->errors.front().message, HasSubstr("errors of its parts"));
}

TEST_F(IndexPass, AnIndexThatWasCutIsMadeAnew) {
    const IndexSource terrain = source();
    ASSERT_TRUE(make_index(terrain, {}));
    fs::resize_file(terrain.file, fs::file_size(terrain.file) / 2);
    const auto index = ErrorIndex::open(terrain);
    ASSERT_TRUE(index && *index);
    EXPECT_FALSE(IndexedTiles(terrain, **index).read(terrain.tree.root()));
    fs::resize_file(terrain.file, 100);
    EXPECT_FALSE((*index)->find(terrain.tree.root()));
    ASSERT_TRUE(make_index(terrain, {}));
    expect_complete(terrain);
}

// All proofs are good: 'index' said so, and left the damage.
TEST_F(IndexPass, AnIndexWithDamagedHeightsIsMadeAnew) {
    const IndexSource terrain = source();
    ASSERT_TRUE(make_index(terrain, {}));
    const auto bytes_of_index = [&] {
        std::ifstream file(terrain.file, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    const std::string made = bytes_of_index();
    std::fstream(terrain.file, std::ios::in | std::ios::out | std::ios::binary)
        .seekp(static_cast<std::streamoff>(made.size() - 1000))
        .write("damage", 6);
    ASSERT_NE(bytes_of_index(), made);
    ASSERT_TRUE(make_index(terrain, {}));
    EXPECT_EQ(bytes_of_index(), made);
}

TEST_F(IndexPass, OfAFileIsTheSameHoweverItsPathIsWritten) {
    const IndexSource by_name = source();
    const fs::path folder = raster().parent_path();
    const fs::path detour = folder / ".." / folder.filename() / "." / "dem.tif";
    for (const fs::path& path : {detour, fs::relative(raster())}) {
        const IndexSource other = source_at(path);
        EXPECT_EQ(other.file, by_name.file) << path;
        EXPECT_EQ(other.fingerprint, by_name.fingerprint) << path;
    }
}

TEST_F(IndexPass, IndexesTheRestOfADamagedFileAndTriesAgain) {
    const std::streamoff block = place_of_block("BLOCK_OFFSET_2_1");
    std::string bytes(64, '\xff');
    damage(bytes, block);
    const IndexSource terrain = source();
    const auto first = make_index(terrain, {});
    ASSERT_TRUE(first) << first.error().message;
    ASSERT_EQ(first->errors.size(), 1U);
    EXPECT_THAT(first->errors.front().message, HasSubstr("dem.tif"));
    EXPECT_GT(first->levels.front().unproven, 0U);
    EXPECT_LT(first->levels.front().unproven, first->levels.front().tiles);
    EXPECT_EQ(first->levels.back().unproven, 1U);
    damage(bytes, block); // as before
    ASSERT_EQ(source().fingerprint, terrain.fingerprint);
    const auto second = make_index(source(), {});
    ASSERT_TRUE(second) << second.error().message;
    EXPECT_TRUE(second->errors.empty());
    expect_complete(terrain);
}

TEST_F(IndexPass, NamesACacheFolderThatCannotBeWritten) {
    const IndexSource terrain = source();
    { const std::ofstream file(cache()); }
    const auto no_folder = make_index(terrain, {});
    ASSERT_FALSE(no_folder);
    EXPECT_THAT(no_folder.error().message, HasSubstr(cache().string()));
    fs::remove(cache());
    fs::create_directory(cache());
    fs::permissions(cache(), fs::perms::owner_read | fs::perms::owner_exec);
    const test::PlainPermissions plain;
    const auto read_only = make_index(terrain, {});
    ASSERT_FALSE(read_only);
    EXPECT_THAT(read_only.error().message, HasSubstr("Permission denied"));
}

TEST_F(IndexPass, IsWrittenByOneProcessAtATime) {
    const IndexSource terrain = source();
    const auto first = ErrorIndex::open_to_write(terrain);
    ASSERT_TRUE(first);
    const auto second = make_index(terrain, {});
    ASSERT_FALSE(second);
    EXPECT_THAT(second.error().message, HasSubstr("another process indexes"));
}

} // namespace
} // namespace reljef::io
