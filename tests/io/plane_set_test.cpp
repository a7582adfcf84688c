// Rasters without a place on Earth as sets of tiles.
#include "engine/io/tile_set.h"

#include <array>
#include <cmath>
#include <set>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/index/error_index.h"
#include "engine/io/index/index_pass.h"
#include "engine/io/terrain_file.h"
#include "tests/io/made_raster.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using test::made_raster;
using ::testing::Contains;
using ::testing::HasSubstr;

struct OnPlane {
    const char* name;
    const char* crs;
    std::array<double, 6> geotransform;
    std::optional<double> spacing = {};
};

const std::array<OnPlane, 6> kinds{{
    {"nothing", "", {0.0, 1.0, 0.0, 0.0, 0.0, 1.0}},
    {"a spacing by the user", "", {0.0, 1.0, 0.0, 0.0, 0.0, 1.0}, 12.5},
    {"metres", "", {5000.0, 30.0, 0.0, 9000.0, 0.0, -20.0}},
    {"rows to the north", "", {5000.0, 30.0, 0.0, 9000.0, 0.0, 30.0}},
    {"columns to the west", "", {5000.0, -30.0, 0.0, 9000.0, 0.0, -30.0}},
    {"feet at a site",
     "LOCAL_CS[\"site\",UNIT[\"foot\",0.3048]]",
     {100.0, 50.0, 0.0, 200.0, 0.0, -50.0}},
}};

double wave(int col, int row) {
    return 100.0 + 40.0 * std::sin(0.3 * col) + 25.0 * std::cos(0.2 * row) + 0.5 * col;
}

TileSetOptions on_plane(std::optional<double> spacing) {
    TileSetOptions options;
    options.allows_planes = true;
    options.spacing = spacing;
    return options;
}

class PlaneSets : public ::testing::Test {
protected:
    [[nodiscard]] std::filesystem::path made(const OnPlane& kind) const {
        auto raster = made_raster(61, 47, wave);
        raster.crs = kind.crs;
        raster.geotransform = kind.geotransform;
        raster.nodata = wave(20, 30);
        EXPECT_TRUE(test::write(raster, folder_.path() / "plane.tif"));
        return folder_.path() / "plane.tif";
    }
    [[nodiscard]] TileSet opened(const OnPlane& kind) const {
        auto tiles = TileSet::open(made(kind), on_plane(kind.spacing));
        EXPECT_TRUE(tiles) << kind.name << ": " << (tiles ? "" : tiles.error().message);
        return std::move(*tiles);
    }

    test::TemporaryFolder folder_;
};

TEST_F(PlaneSets, AreTheTerrainThatIsReadWhole) {
    for (const OnPlane& kind : kinds) {
        SCOPED_TRACE(kind.name);
        RasterOptions options;
        options.spacing = kind.spacing;
        const auto whole = read_terrain(made(kind), options);
        ASSERT_TRUE(whole) << whole.error().message;
        const TileSet tiles = opened(kind);
        EXPECT_TRUE(tiles.is_on_plane());
        const auto terrain = tiles.terrain();
        ASSERT_TRUE(terrain) << terrain.error().message;
        const terrain::Heightfield& a = terrain->heightfield;
        const terrain::Heightfield& b = whole->heightfield;
        EXPECT_EQ(a.heights, b.heights);
        EXPECT_EQ(a.void_mask, b.void_mask);
        EXPECT_EQ(a.void_count, 1U);
        EXPECT_NEAR(a.spacing.x, b.spacing.x, 1e-9 * b.spacing.x);
        EXPECT_NEAR(a.spacing.y, b.spacing.y, 1e-9 * b.spacing.y);
        EXPECT_FALSE(a.georeference);
        for (const std::string& note : whole->notes) {
            EXPECT_THAT(terrain->notes, Contains(note));
        }
    }
}

TEST_F(PlaneSets, ReducedSamplesAreMeansAsFarApartAsTheirBlocks) {
    for (const OnPlane& kind : kinds) {
        SCOPED_TRACE(kind.name);
        const TileSet tiles = opened(kind);
        TileTerrainOptions options;
        options.raster.memory_budget = 12 * 10 * bytes_per_sample;
        const auto all = tiles.terrain();
        const auto reduced = tiles.terrain(options);
        ASSERT_TRUE(all && reduced);
        const terrain::Heightfield& fine = all->heightfield;
        const terrain::Heightfield& coarse = reduced->heightfield;
        const int k = static_cast<int>(coarse.reduction);
        EXPECT_GT(k, 4);
        EXPECT_NEAR(coarse.spacing.x, k * fine.spacing.x, 1e-9 * coarse.spacing.x);
        EXPECT_NEAR(coarse.spacing.y, k * fine.spacing.y, 1e-9 * coarse.spacing.y);
        double sum = 0.0;
        for (int row = 0; row < k; ++row) {
            for (int col = 0; col < k; ++col) {
                sum += fine.heights(col, row);
            }
        }
        EXPECT_NEAR(coarse.heights(0, 0), sum / (k * k), 1e-3);
    }
}

TEST_F(PlaneSets, AreIndexedByTheirSpacingAndContent) {
    const auto source_of = [&](const TileSet& tiles) {
        auto source = index_source(tiles, tiles.grid(), Gaps::holes, folder_.path() / "cache");
        EXPECT_TRUE(source) << (source ? "" : source.error().message);
        return std::move(*source);
    };
    std::set<std::filesystem::path> files;
    for (const OnPlane& kind : kinds) {
        SCOPED_TRACE(kind.name);
        const TileSet tiles = opened(kind);
        const IndexSource source = source_of(tiles);
        files.insert(source.file);
        ASSERT_TRUE(make_index(source, {}));
        const auto index = ErrorIndex::open(source);
        ASSERT_TRUE(index && *index);
        EXPECT_TRUE((*index)->is_complete());
        const auto root = (*index)->find(source.tree.root());
        ASSERT_TRUE(root);
        const terrain::HeightRange range = tiles.terrain()->heightfield.range;
        EXPECT_LE(root->low, range.low);
        EXPECT_GE(root->high, range.high);
        EXPECT_LE(root->high - root->low, range.high - range.low + 2.0 * root->range_step);
        EXPECT_TRUE(root->has_voids);
    }
    EXPECT_GE(files.size(), 4U) << "by spacing";
    const IndexSource before = source_of(opened(kinds[0]));
    std::filesystem::last_write_time(folder_.path() / "plane.tif", {});
    EXPECT_NE(source_of(opened(kinds[0])).fingerprint, before.fingerprint);
}

// A picture of two halves over rasters of all orientations, read whole and in reduced samples.
TEST_F(PlaneSets, PicturesAreStretchedOverTheFilesPixels) {
    auto picture = made_raster(61, 47, [](int, int) { return 0.0; });
    picture.type = GDT_Byte;
    picture.bands = 3;
    picture.values.assign(std::size_t{3} * 61 * 47, 0.0);
    std::fill_n(picture.values.begin(), 61 * 23, 255.0); // red in the first rows of the file
    ASSERT_TRUE(test::write(picture, folder_.path() / "picture.tif"));
    for (const OnPlane& kind : kinds) {
        SCOPED_TRACE(kind.name);
        RasterOptions options;
        options.spacing = kind.spacing;
        options.imagery = {folder_.path() / "picture.tif"};
        const auto whole = read_terrain(made(kind), options);
        ASSERT_TRUE(whole) << whole.error().message;
        TileTerrainOptions of_set;
        of_set.raster.imagery = options.imagery;
        const auto all = opened(kind).terrain(of_set);
        ASSERT_TRUE(all) << all.error().message;
        EXPECT_EQ(all->color, whole->color);
        of_set.raster.memory_budget = 12 * 10 * bytes_per_sample;
        const auto reduced = opened(kind).terrain(of_set);
        ASSERT_TRUE(reduced) << reduced.error().message;
        const bool is_red_north = whole->color(0, 0).r > 200;
        EXPECT_EQ(is_red_north, std::string_view(kind.name) != "rows to the north");
        EXPECT_EQ(reduced->color(1, 1).r > 200, is_red_north);
    }
}

TEST_F(PlaneSets, HaveNoHeightsAtPlacesOnEarth) {
    const TileSet tiles = opened(kinds[2]);
    const std::array places{glm::dvec2(0.0, 0.0), glm::dvec2(45.0, 6.0)};
    for (const HeightSample& answer : tiles.heights(places).answers) {
        EXPECT_EQ(answer.kind, HeightSample::Kind::outside);
    }
}

TEST_F(PlaneSets, AreOnlyThoseThatAreAskedFor) {
    for (const OnPlane& kind : kinds) {
        if (!kind.spacing) {
            EXPECT_FALSE(TileSet::open(made(kind))) << kind.name;
        }
    }
    EXPECT_FALSE(TileSet::open(made(kinds[0]), on_plane(1e300)));
    const OnPlane on_earth{"", "EPSG:32631", {5e5, 30.0, 0.0, 5e6, 0.0, -30.0}};
    EXPECT_FALSE(TileSet::open(made(on_earth), on_plane(2.0))) << "the file has its own";
}

TEST_F(PlaneSets, OfAFileThatWasReplacedAreReadOnlyInItsSize) {
    const TileSet tiles = opened(kinds[0]);
    const auto other = [&](int cols, double height) {
        auto raster = made_raster(cols, 47, [&](int, int) { return height; });
        EXPECT_TRUE(test::write(raster, folder_.path() / "new.tif"));
        std::filesystem::rename(folder_.path() / "new.tif", folder_.path() / "plane.tif");
        return tiles.read(tiles.grid(), Gaps::holes);
    };
    const TileWindow same_size = other(61, 7.0);
    EXPECT_TRUE(same_size.errors.empty());
    EXPECT_EQ(same_size.heights(10, 10), 7.0);
    const TileWindow other_size = other(62, 8.0);
    ASSERT_EQ(other_size.errors.size(), 1U);
    EXPECT_THAT(other_size.errors.front().message, HasSubstr("was replaced while it was open"));
}

} // namespace
} // namespace reljef::io
