#include "engine/io/tile_set.h"

#include <chrono>
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/io/made_raster.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

namespace reljef::io {
namespace {

using test::made_raster;
using ::testing::HasSubstr;
using Kind = HeightSample::Kind;

/// West, north of the outer corner, and the step, in the units of the CRS.
struct Corner {
    double x = 0.0;
    double y = 0.0;
    double step = 1.0;
};

class TileSets : public ::testing::Test {
protected:
    /// A raster of value(x, y) at its samples' places in its CRS.
    template <class Value>
    std::filesystem::path tile(const std::string& name, const std::string& crs, int cols, int rows,
                               Corner corner, const Value& value,
                               GDALDataType type = GDT_Float64) const {
        auto raster = made_raster(cols, rows, [&](int col, int row) {
            return value(corner.x + (col + 0.5) * corner.step,
                         corner.y - (row + 0.5) * corner.step);
        });
        raster.type = type;
        raster.crs = crs;
        raster.nodata = -9999.0;
        raster.geotransform = {corner.x, corner.step, 0.0, corner.y, 0.0, -corner.step};
        EXPECT_TRUE(test::write(raster, folder_.path() / name));
        return folder_.path() / name;
    }
    [[nodiscard]] TileSet open(const TileSetOptions& options = {}) const {
        auto tiles = TileSet::open(folder_.path(), options);
        EXPECT_TRUE(tiles) << (tiles ? "" : tiles.error().message);
        return std::move(*tiles);
    }
    [[nodiscard]] terrain::Terrain drawn(const TileTerrainOptions& options = {}) const {
        auto terrain = open().terrain(options);
        EXPECT_TRUE(terrain) << (terrain ? "" : terrain.error().message);
        return terrain ? std::move(*terrain) : terrain::Terrain{};
    }
    static void make_older(const std::filesystem::path& file) {
        std::filesystem::last_write_time(file, std::filesystem::last_write_time(file) -
                                                   std::chrono::hours(1));
    }

    test::TemporaryFolder folder_;
};

constexpr const char* utm31 = "EPSG:32631";

double plane(double x, double y) {
    return 0.25 * (x - 500000.0) + 0.5 * (y - 5000000.0);
}

TEST_F(TileSets, NeighboursJoinWithoutASeamOrAStep) {
    // Four area-registered tiles that share no sample: the cells between them are of both.
    for (const int i : {0, 1}) {
        for (const int j : {0, 1}) {
            tile("t" + std::to_string(i) + std::to_string(j) + ".tif", utm31, 20, 30,
                 {500000.0 + i * 200.0, 5000000.0 - j * 300.0, 10.0}, plane);
        }
    }
    const auto terrain = drawn();
    const auto& heightfield = terrain.heightfield;
    ASSERT_EQ(heightfield.heights.cols(), 40);
    ASSERT_EQ(heightfield.heights.rows(), 60);
    EXPECT_EQ(heightfield.void_count, 0U);
    EXPECT_EQ(heightfield.spacing, glm::dvec2(10.0));
    for (int row = 0; row < 60; ++row) {
        for (int col = 0; col < 40; ++col) {
            ASSERT_EQ(heightfield.heights(col, row),
                      static_cast<float>(plane(500005.0 + 10.0 * col, 4999995.0 - 10.0 * row)));
        }
    }
}

// The steps of the whole are 5 to 14 km, each tile is 640 m wide.
TEST_F(TileSets, ATileFarFromTheOthersDoesNotMakeAllVoid) {
    for (const int i : {0, 1}) {
        tile(fmt::format("{}.tif", i), "EPSG:32633", 64, 64,
             {500000.0 + i * 640.0, 5000000.0, 10.0}, [](double, double) { return 100.0; });
    }
    tile("pole.tif", "EPSG:3995", 64, 64, {0.0, 0.0, 10.0}, [](double, double) { return 200.0; });
    TileTerrainOptions options;
    options.raster.memory_budget = 30'000'000; // 740×976 samples
    const auto field = drawn(options).heightfield;
    EXPECT_LT(field.void_count, field.heights.size());
    EXPECT_EQ(field.range.high, 200.0);
}

TEST_F(TileSets, HeightsBetweenTilesAreBilinearBetweenTheirSamples) {
    tile("a.tif", utm31, 20, 20, {500000.0, 5000000.0, 10.0}, plane);
    tile("b.tif", utm31, 20, 20, {500200.0, 5000000.0, 10.0}, plane);
    auto terrain = drawn();
    const auto& place = *terrain.heightfield.georeference;
    std::vector<glm::dvec2> places;
    std::vector<glm::dvec2> samples;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> cols(0.0, 39.0);
    std::uniform_real_distribution<double> rows(0.0, 19.0);
    for (int i = 0; i < 2000; ++i) {
        samples.emplace_back(i % 4 == 0 ? 19.0 + cols(random) / 39.0 : cols(random), rows(random));
        places.push_back(place.geodetic.latitude_longitude(samples.back()));
    }
    const auto found = open().heights(places);
    for (std::size_t i = 0; i < places.size(); ++i) {
        ASSERT_EQ(found.answers[i].kind, Kind::height);
        const glm::dvec2 at = place.crs_from_pixel.crs_from_pixel(samples[i]);
        // 0.1 mm: what the fitted map of positions may be wrong by, on a slope under 1.
        ASSERT_NEAR(found.answers[i].height, plane(at.x, at.y), 1e-4);
    }
}

TEST_F(TileSets, FinerSpacingWinsThenTheNewer) {
    const auto constant = [](double height) { return [=](double, double) { return height; }; };
    tile("coarse.tif", utm31, 20, 20, {500000.0, 5000000.0, 20.0}, constant(1.0));
    const auto older = tile("older.tif", utm31, 20, 20, {500000.0, 5000000.0, 10.0}, constant(2.0));
    tile("newer.tif", utm31, 20, 20, {500100.0, 5000000.0, 10.0}, constant(3.0));
    make_older(older);
    const auto terrain = drawn();
    const auto& heights = terrain.heightfield.heights;
    EXPECT_EQ(heights(5, 5), 2.0F);
    EXPECT_EQ(heights(10, 5), 3.0F);
    EXPECT_EQ(heights(29, 5), 3.0F);
    EXPECT_EQ(heights(31, 5), 1.0F);
    EXPECT_EQ(heights(5, 25), 1.0F);
    EXPECT_EQ(open().files().front().path.filename(), "newer.tif");
}

TEST_F(TileSets, AVoidOfAFinerTileShowsTheCoarserOne) {
    tile("coarse.tif", utm31, 40, 40, {500000.0, 5000000.0, 20.0}, plane);
    tile("fine.tif", utm31, 40, 40, {500000.0, 5000000.0, 10.0}, [](double x, double y) {
        return x > 500100.0 && x < 500200.0 && y < 4999900.0 ? -9999.0 : 7.0;
    });
    const auto terrain = drawn();
    EXPECT_EQ(terrain.heightfield.void_count, 0U);
    EXPECT_EQ(terrain.heightfield.heights(5, 20), 7.0F);
    const auto& affine = terrain.heightfield.georeference->crs_from_pixel;
    const glm::dvec2 inside = affine.crs_from_pixel({15.0, 20.0});
    EXPECT_NEAR(terrain.heightfield.heights(15, 20), plane(inside.x, inside.y), 1e-4);
}

TEST_F(TileSets, GapsAreHolesOrSeaAsSetAndVoidsStayVoids) {
    tile("a.tif", utm31, 10, 10, {500000.0, 5000000.0, 10.0},
         [](double x, double y) { return x < 500010.0 && y > 4999990.0 ? -9999.0 : 50.0; });
    tile("b.tif", utm31, 10, 10, {500200.0, 5000000.0, 10.0}, [](double, double) { return 60.0; });
    const auto holes = drawn();
    EXPECT_EQ(holes.heightfield.void_count, 1U + 10U * 10U);
    EXPECT_EQ(holes.heightfield.void_mask(15, 3), 1);
    TileTerrainOptions options;
    options.gaps = Gaps::sea;
    const auto sea = drawn(options);
    EXPECT_EQ(sea.heightfield.void_count, 1U);
    EXPECT_EQ(sea.heightfield.void_mask(0, 0), 1);
    EXPECT_EQ(sea.heightfield.heights(15, 3), 0.0F);
    EXPECT_EQ(sea.heightfield.heights(20, 3), 60.0F);
}

TEST_F(TileSets, ReducedSamplesAreTheMeansOfWholeBlocksAcrossTiles) {
    const auto rough = [](double x, double y) { return std::fmod(7.0 * x + 13.0 * y, 101.0); };
    for (const int i : {0, 1}) { // 22 samples: no multiple of 4, blocks lie across the join
        tile("t" + std::to_string(i) + ".tif", utm31, 22, 40,
             {500000.0 + i * 220.0, 5000000.0, 10.0}, rough);
    }
    TileTerrainOptions options;
    options.raster.memory_budget = 11 * 10 * bytes_per_sample;
    const auto terrain = drawn(options);
    const auto& heights = terrain.heightfield.heights;
    ASSERT_EQ(heights.cols(), 11);
    ASSERT_EQ(heights.rows(), 10);
    for (int row = 0; row < 10; ++row) {
        for (int col = 0; col < 11; ++col) {
            double sum = 0.0;
            for (int k = 0; k < 16; ++k) {
                sum += rough(500005.0 + 10.0 * (4 * col + k % 4),
                             4999995.0 - 10.0 * (4 * row + k / 4));
            }
            ASSERT_NEAR(heights(col, row), sum / 16.0, 1e-5) << col << " " << row;
        }
    }
    EXPECT_THAT(test::joined(terrain.notes), HasSubstr("1/4 of the finest"));
}

TEST_F(TileSets, APictureWithoutAPlaceLiesOverReducedSamplesAsOverAll) {
    tile("heights.tif", utm31, 46, 42, {500000.0, 5000000.0, 10.0}, plane); // two over from 4s
    auto picture = made_raster(92, 84, [](int col, int) { return 2 * col; });
    const auto green = made_raster(92, 84, [](int, int row) { return 2 * row; });
    for (int band = 0; band < 2; ++band) {
        picture.values.insert(picture.values.end(), green.values.begin(), green.values.end());
    }
    picture.bands = 3;
    picture.type = GDT_Byte;
    const test::TemporaryFolder beside;
    ASSERT_TRUE(test::write(picture, beside.path() / "picture.tif"));
    TileTerrainOptions options;
    options.raster.memory_budget = 11 * 10 * bytes_per_sample;
    options.raster.imagery = {beside.path() / "picture.tif"};
    const Image color = drawn(options).color;
    ASSERT_GT(color.cols(), 10);
    for (int row = 0; row < color.rows(); ++row) {
        for (int col = 0; col < color.cols(); ++col) {
            const glm::dvec2 sample = glm::dvec2(col, row) * glm::dvec2(10.0, 9.0) /
                                      glm::dvec2(color.cols() - 1, color.rows() - 1);
            const glm::dvec2 pixel = 2.0 * (4.0 * sample + 2.0) - 0.5; // two pixels a sample
            ASSERT_NEAR(color(col, row).r, 2.0 * pixel.x, 1.5) << col << " " << row;
            ASSERT_NEAR(color(col, row).g, 2.0 * pixel.y, 1.5) << col << " " << row;
        }
    }
}

double hills(double longitude, double latitude) {
    return 500.0 + 300.0 * std::sin(40.0 * longitude) * std::cos(50.0 * latitude);
}

TEST_F(TileSets, NeighboursOfDifferentSystemsAndSpacingJoinWatertight) {
    // Degrees beside a projected tile that overlaps them by a little.
    tile("west.tif", "EPSG:4326", 300, 200, {2.9, 45.1, 0.0005}, hills);
    OGRSpatialReference utm;
    utm.importFromEPSG(32631);
    utm.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    OGRSpatialReference degrees;
    degrees.importFromEPSG(4326);
    degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const std::unique_ptr<OGRCoordinateTransformation> back(
        OGRCreateCoordinateTransformation(&utm, &degrees));
    tile("east.tif", utm31, 400, 400, {503900.0, 4995000.0, 30.0}, [&](double x, double y) {
        back->Transform(1, &x, &y);
        return hills(x, y);
    });
    const TileSet tiles = open();
    EXPECT_EQ(tiles.crs_name(), "WGS 84");
    TileTerrainOptions options;
    options.area = geo::GeodeticArea{45.01, 2.91, 45.09, 3.19};
    auto terrain = tiles.terrain(options);
    ASSERT_TRUE(terrain) << terrain.error().message;
    const auto& heightfield = terrain->heightfield;
    EXPECT_EQ(heightfield.void_count, 0U);
    const auto& affine = heightfield.georeference->crs_from_pixel;
    double worst = 0.0;
    for (int row = 0; row < heightfield.heights.rows(); ++row) {
        for (int col = 0; col < heightfield.heights.cols(); ++col) {
            const glm::dvec2 at = affine.crs_from_pixel(glm::dvec2(col, row));
            worst = std::max(worst, std::abs(heightfield.heights(col, row) - hills(at.x, at.y)));
        }
    }
    // Bilinear over 0.0005°: h²/8 · (second derivatives, 300·(40² + 50²)) = 0.04 m.
    EXPECT_LT(worst, 0.08);
}

TEST_F(TileSets, TheAntimeridianIsNoEdge) {
    const auto waves = [](double longitude, double latitude) {
        return 100.0 * std::sin(longitude * std::acos(-1.0) / 18.0) + latitude;
    };
    tile("east.tif", "EPSG:4326", 100, 50, {179.0, -16.0, 0.01}, waves);
    tile("west.tif", "EPSG:4326", 100, 50, {-180.0, -16.0, 0.01}, waves);
    const auto terrain = drawn();
    ASSERT_EQ(terrain.heightfield.heights.cols(), 200);
    EXPECT_EQ(terrain.heightfield.void_count, 0U);
    EXPECT_EQ(terrain.heightfield.heights(100, 3), static_cast<float>(waves(-179.995, -16.035)));
    const std::vector<glm::dvec2> places{
        {-16.2, 180.0}, {-16.2, -180.0}, {-16.2, 179.9999}, {-16.2, 180.0001}};
    for (const HeightSample& answer : open().heights(places).answers) {
        ASSERT_EQ(answer.kind, Kind::height);
        EXPECT_NEAR(answer.height, -16.2, 1e-2);
    }
}

TEST_F(TileSets, WhatCannotBeUsedIsToldOnceAndTheRestIsThere) {
    tile("good.tif", utm31, 20, 20, {500000.0, 5000000.0, 10.0}, plane);
    const auto cut = tile("cut.tif", utm31, 60, 60, {500200.0, 5000000.0, 10.0}, plane);
    std::filesystem::resize_file(cut, std::filesystem::file_size(cut) / 2);
    tile("nowhere.tif", "", 20, 20, {500400.0, 5000000.0, 10.0}, plane);
    folder_.write("empty.tif", "");
    folder_.write("noise.hgt", "not heights");
    folder_.write("readme.txt", "no raster");
    const auto terrain = drawn();
    EXPECT_EQ(terrain.heightfield.heights(3, 3), static_cast<float>(plane(500035.0, 4999965.0)));
    const std::string told = test::joined(terrain.errors);
    ASSERT_EQ(terrain.errors.size(), 4U) << told;
    for (const char* name : {"cut.tif: cannot be ", "nowhere.tif: names no place",
                             "empty.tif: is empty", "noise.hgt: cannot be opened"}) {
        EXPECT_THAT(told, HasSubstr(name));
    }
}

TEST_F(TileSets, ATileInASystemWithoutDefinitionIsAFault) {
    tile("good.tif", utm31, 20, 20, {500000.0, 5000000.0, 10.0}, plane);
    tile("local.tif", "LOCAL_CS[\"somewhere\",UNIT[\"metre\",1]]", 20, 20,
         {500200.0, 5000000.0, 10.0}, plane);
    const TileSet tiles = open();
    ASSERT_EQ(tiles.errors().size(), 1U);
    EXPECT_THAT(tiles.errors()[0].message, HasSubstr("local.tif: names no place"));
}

TEST_F(TileSets, AFileOfMoreSamplesThanATreeReachesIsAFault) {
    tile("small.tif", utm31, 4, 4, {500000.0, 5000000.0, 10.0}, plane, GDT_Byte);
    for (const char* east : {"500000", "550000"}) { // 500,000,000 samples apart
        folder_.write(std::string(east) + ".vrt",
                      "<VRTDataset rasterXSize=\"2000000000\" rasterYSize=\"4\"><SRS>EPSG:32631"
                      "</SRS><GeoTransform>" +
                          std::string(east) +
                          ",1e-4,0,5000000,0,-1e-4</GeoTransform><VRTRasterBand dataType=\"Byte\" "
                          "band=\"1\"/></VRTDataset>");
    }
    const TileSet tiles = open();
    EXPECT_EQ(tiles.files().size(), 1U);
    ASSERT_EQ(tiles.errors().size(), 2U);
    EXPECT_THAT(tiles.errors()[1].message,
                HasSubstr("550000.vrt: has 2000000000×4 samples, at most 1073741824 a side"));
}

TEST_F(TileSets, TilesMayLieFartherApartThanATreeReaches) {
    const std::array<double, 4> begins{500000.0, 350000.0, 650000.0, 499999.9995};
    for (std::size_t i = 0; i < begins.size(); ++i) {
        tile(std::to_string(i) + ".tif", utm31, 4, 4, {begins[i], 5000000.0, 1e-4},
             [&](double, double) { return 10.0 * static_cast<double>(i); });
    }
    const TileSet tiles = open(); // 3,000,000,000 samples apart
    EXPECT_EQ(tiles.files().size(), 4U);
    EXPECT_TRUE(tiles.errors().empty());
    ASSERT_EQ(tiles.notes().size(), 1U);
    EXPECT_THAT(tiles.notes()[0], HasSubstr("it is seen in steps of 3"));
    EXPECT_NEAR(tiles.grid().cols, 1e9, 3.0);
    EXPECT_NEAR(tiles.grid().first.x, 350000.0, 3e-4);
    for (std::size_t i = 0; i < begins.size(); ++i) {
        const TileGrid at{{begins[i] + 1.5e-4, 5000000.0 - 1.5e-4}, {1e-4, -1e-4}, 2, 2};
        EXPECT_EQ(tiles.read(at, Gaps::holes).heights(1, 1), 10.0 * static_cast<double>(i));
    }
}

TEST_F(TileSets, PicturesBesideTilesAreNoHeights) {
    tile("good.tif", utm31, 20, 20, {500000.0, 5000000.0, 10.0}, plane);
    auto picture = made_raster(20, 20, [](int col, int) { return col; });
    picture.values.insert(picture.values.end(), picture.values.begin(), picture.values.end());
    picture.values.insert(picture.values.end(), picture.values.begin(),
                          picture.values.begin() + 400);
    picture.bands = 3;
    picture.type = GDT_Byte;
    picture.colors = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand};
    ASSERT_TRUE(test::write(picture, folder_.path() / "picture.tif"));
    const TileSet tiles = open();
    EXPECT_EQ(tiles.files().size(), 1U);
    EXPECT_TRUE(tiles.errors().empty());
    ASSERT_EQ(tiles.notes().size(), 1U);
    EXPECT_THAT(tiles.notes()[0], HasSubstr("1 picture in colour"));
}

TEST_F(TileSets, AFolderWithoutAnyTileIsAnError) {
    const auto none = TileSet::open(folder_.path());
    ASSERT_FALSE(none);
    EXPECT_THAT(none.error().message, HasSubstr("holds no raster of heights"));
    folder_.write("empty.tif", "");
    const auto unusable = TileSet::open(folder_.path());
    ASSERT_FALSE(unusable);
    EXPECT_THAT(unusable.error().message, HasSubstr("empty.tif"));
}

TEST_F(TileSets, AnAreaBesideAllTilesIsAnError) {
    tile("a.tif", utm31, 20, 20, {500000.0, 5000000.0, 10.0}, plane);
    const auto part = open().part(open().grid(), geo::GeodeticArea{10.0, 3.0, 11.0, 4.0});
    ASSERT_FALSE(part);
    EXPECT_THAT(part.error().message, HasSubstr("has nothing from 10 to 11 north"));
}

class TileCache : public TileSets {
protected:
    TileCache() {
        options_.cache_folder = cache_.path() / "below";
        tile("a.tif", utm31, 20, 20, {500000.0, 5000000.0, 10.0}, plane);
    }
    [[nodiscard]] std::filesystem::path file() const {
        return *std::filesystem::directory_iterator(options_.cache_folder);
    }
    test::TemporaryFolder cache_;
    TileSetOptions options_;
};

TEST_F(TileCache, IsMadeOnceAndReadAgain) {
    static_cast<void>(open(options_));
    const std::string bytes = test::read_bytes(file());
    ASSERT_FALSE(bytes.empty());
    // An index that knows less of the file shows that the file is not asked again.
    std::string changed = bytes;
    const auto at = changed.find("Float64");
    ASSERT_NE(at, std::string::npos);
    EXPECT_TRUE(open(options_).notes().empty());
    EXPECT_EQ(test::read_bytes(file()), bytes);
}

TEST_F(TileCache, ThatIsCutOrOfAnotherVersionIsMadeAnewAndTold) {
    static_cast<void>(open(options_));
    const std::string bytes = test::read_bytes(file());
    std::mt19937 random(1);
    for (int i = 0; i < 200; ++i) {
        std::string broken = bytes;
        if (i % 2 == 0) {
            broken.resize(random() % bytes.size());
        } else {
            broken[random() % bytes.size()] ^= static_cast<char>(1 + random() % 255);
        }
        cache_.write("below/" + file().filename().string(), broken);
        const TileSet tiles = open(options_);
        ASSERT_EQ(tiles.files().size(), 1U);
        ASSERT_EQ(tiles.notes().size(), 1U);
        ASSERT_THAT(tiles.notes()[0], HasSubstr("indexed anew"));
        ASSERT_EQ(test::read_bytes(file()), bytes);
    }
}

TEST_F(TileCache, KnowsWhenFilesChangeComeAndGo) {
    ASSERT_EQ(open(options_).files().front().cols, 20);
    tile("a.tif", utm31, 30, 30, {500000.0, 5000000.0, 10.0}, plane);
    EXPECT_EQ(open(options_).files().front().cols, 30);
    tile("b.tif", utm31, 20, 20, {500300.0, 5000000.0, 10.0}, plane);
    EXPECT_EQ(open(options_).files().size(), 2U);
    std::filesystem::remove(folder_.path() / "a.tif");
    EXPECT_EQ(open(options_).files().size(), 1U);
}

// What a file held is gone, its size and time are what they were: opened anew it would be a fault.
// The few that are opened to check the index tell nothing.
TEST_F(TileCache, BelievesManyFilesThatAreTheSame) {
    for (int i = 0; i < 200; ++i) {
        tile("n" + std::to_string(i) + ".tif", utm31, 8, 8,
             {500000.0 + 80.0 * (i % 40), 4990000.0 + 80.0 * (i / 40), 10.0}, plane);
    }
    ASSERT_EQ(open(options_).files().size(), 201U);
    for (const auto& file : std::filesystem::directory_iterator(folder_.path())) {
        const auto time = std::filesystem::last_write_time(file);
        folder_.write(file.path().filename().string(), std::string(file.file_size(), '-'));
        std::filesystem::last_write_time(file, time);
    }
    const TileSet again = open(options_);
    EXPECT_EQ(again.files().size(), 201U);
    EXPECT_TRUE(again.errors().empty());
    EXPECT_FALSE(TileSet::open(folder_.path())) << "without the cache they are opened";
}

TEST_F(TileCache, ThatCannotBeWrittenIsDoneWithout) {
    options_.cache_folder = cache_.write("a file", "where a folder should be") / "below";
    EXPECT_EQ(open(options_).files().size(), 1U);
}

TEST(RealTiles, TheAlpineBlockIsOneTerrainOfItsFilesOwnSamples) {
    RELJEF_RELEASE_ONLY("made tiles are read by the same lines");
    RELJEF_NEED_DATA("natural/srtm3/N44E006.hgt");
    const test::TemporaryFolder folder;
    const std::array<const char*, 4> names{"N44E006.hgt", "N44E007.hgt", "N45E006.hgt",
                                           "N45E007.hgt"};
    for (const char* name : names) {
        std::filesystem::create_symlink(
            std::filesystem::absolute(test::data_path(std::string("natural/srtm3/") + name)),
            folder.path() / name);
    }
    const auto tiles = TileSet::open(folder.path());
    ASSERT_TRUE(tiles) << tiles.error().message;
    const auto terrain = tiles->terrain();
    ASSERT_TRUE(terrain) << terrain.error().message;
    const auto& heights = terrain->heightfield.heights;
    ASSERT_EQ(heights.cols(), 2401);
    ASSERT_EQ(heights.rows(), 2401);
    EXPECT_EQ(terrain->heightfield.void_count, 0U);
    EXPECT_EQ(terrain->heightfield.georeference->vertical_datum, "EGM96 height");
    for (std::size_t i = 0; i < names.size(); ++i) {
        const std::string bytes = test::read_bytes(folder.path() / names[i]);
        const int first_col = names[i][6] == '7' ? 1200 : 0;
        const int first_row = names[i][2] == '4' ? 1200 : 0;
        for (int k = 0; k < 1201 * 1201; ++k) {
            const auto at = static_cast<std::size_t>(2 * k);
            const auto stored =
                static_cast<std::int16_t>(static_cast<unsigned char>(bytes[at]) << 8U |
                                          static_cast<unsigned char>(bytes[at + 1]));
            ASSERT_EQ(heights(first_col + k % 1201, first_row + k / 1201), stored);
        }
    }
}

} // namespace
} // namespace reljef::io
