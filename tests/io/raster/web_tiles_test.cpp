#include "engine/io/raster/web_tiles.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/tile_set.h"
#include "tests/io/made_raster.h"
#include "tests/support/nginx.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

namespace reljef::io {
namespace {

using ::testing::HasSubstr;

constexpr int pixels_a_side = 256;

TEST(HeightEncodings, AreTheFormulasOfTheirAuthors) {
    const auto terrarium = HeightEncoding::terrarium;
    EXPECT_EQ(encoded_height(terrarium, 128.0, 0.0, 0.0), 0.0);
    EXPECT_EQ(encoded_height(terrarium, 162.0, 144.0, 128.0), 8848.5);
    EXPECT_EQ(encoded_height(terrarium, 85.0, 22.0, 0.0), -10986.0);
    const auto terrain_rgb = HeightEncoding::terrain_rgb;
    EXPECT_EQ(encoded_height(terrain_rgb, 1.0, 134.0, 160.0), 0.0);
    EXPECT_NEAR(encoded_height(terrain_rgb, 1.0, 134.0, 161.0), 0.1, 1e-9);
    EXPECT_NEAR(encoded_height(terrain_rgb, 2.0, 224.0, 68.0), 8848.4, 1e-9);
    for (const auto encoding : {terrarium, terrain_rgb}) {
        EXPECT_TRUE(std::isnan(encoded_height(encoding, 0.0, 0.0, 0.0)));
    }
}

/// Heights of level 6 by formula, in steps that both encodings have: multiples of half a metre.
double height_at_pixel(double x, double y) {
    return 0.5 * std::round(3000.0 + 2000.0 * std::sin(0.021 * x) * std::cos(0.017 * y));
}

/// The place of a pixel's middle, latitude and longitude, by the formulas of web mercator.
glm::dvec2 place_of_pixel(double x, double y, int level) {
    const double count = std::ldexp(1.0, level) * pixels_a_side;
    const double pi = std::numbers::pi;
    return {std::atan(std::sinh(pi * (1.0 - 2.0 * (y + 0.5) / count))) * 180.0 / pi,
            (x + 0.5) / count * 360.0 - 180.0};
}

class TilePyramids : public ::testing::TestWithParam<const char*> {
protected:
    /// Tiles (33, 22) to (34, 23) of level 6, but not (34, 23), and one above them.
    TilePyramids() {
        for (const glm::ivec2 tile : {glm::ivec2(33, 22), {34, 22}, {33, 23}}) {
            write_tile(6, tile, 1);
        }
        write_tile(5, {16, 11}, 2);
    }
    void write_tile(int level, glm::ivec2 tile, int step) const {
        const glm::ivec2 first = tile * pixels_a_side;
        test::MadeRaster raster =
            test::made_raster(pixels_a_side, pixels_a_side, [](int, int) { return 0; });
        raster.values.clear();
        for (int band = 0; band < 3; ++band) {
            for (int row = 0; row < pixels_a_side; ++row) {
                for (int col = 0; col < pixels_a_side; ++col) {
                    const double height =
                        height_at_pixel((first.x + col) * step, (first.y + row) * step);
                    raster.values.push_back(channel(height, band));
                }
            }
        }
        raster.bands = 3;
        raster.type = GDT_Byte;
        raster.format = "PNG";
        const auto folder = folder_.path() / std::to_string(level) / std::to_string(tile.x);
        std::filesystem::create_directories(folder);
        ASSERT_TRUE(test::write(raster, folder / (std::to_string(tile.y) + ".png")));
        std::filesystem::remove(folder / (std::to_string(tile.y) + ".png.aux.xml"));
    }
    /// Of a height's red, green and blue.
    [[nodiscard]] static int channel(double height, int band) {
        const bool terrarium = std::string(GetParam()) == "terrarium+";
        const auto code = static_cast<int>(
            std::lround(terrarium ? (height + 32768.0) * 256.0 : (height + 10000.0) * 10.0));
        return (code >> (16 - 8 * band)) & 255;
    }
    void expect_heights(const TileSet& tiles) const {
        std::vector<glm::dvec2> places;
        std::vector<double> heights;
        for (int i = 0; i < 2000; ++i) { // across the borders of tiles, too
            const int x = 33 * pixels_a_side + (i * 7) % 500;
            const int y = 22 * pixels_a_side + (i * 11) % 250;
            places.push_back(place_of_pixel(x, y, 6));
            heights.push_back(height_at_pixel(x, y));
        }
        const auto found = tiles.heights(places);
        ASSERT_TRUE(found.errors.empty()) << found.errors.front().message;
        for (std::size_t i = 0; i < places.size(); ++i) {
            ASSERT_EQ(found.answers[i].kind, HeightSample::Kind::height) << i;
            ASSERT_NEAR(found.answers[i].height, heights[i], 1e-9) << i;
        }
    }
    [[nodiscard]] std::filesystem::path name() const {
        return GetParam() + folder_.path().string();
    }

    test::TemporaryFolder folder_;
};

TEST_P(TilePyramids, GiveTheHeightsOfTheirColours) {
    const auto tiles = TileSet::open(name());
    ASSERT_TRUE(tiles) << tiles.error().message;
    expect_heights(*tiles);
    const auto missing = tiles->heights(std::vector{place_of_pixel(34 * 256 + 9, 23 * 256 + 9, 6)});
    EXPECT_EQ(missing.answers.front().kind, HeightSample::Kind::in_void);
}

TEST_P(TilePyramids, ComeFromAnAddressToo) {
    RELJEF_NEED_NGINX();
    const test::Nginx server(folder_.path());
    const auto tiles = TileSet::open(GetParam() + server.url("{z:6}/{x}/{y}.png"));
    ASSERT_TRUE(tiles) << tiles.error().message;
    expect_heights(*tiles);
}

// Not there is nothing there; a failure is told, and over once the server has recovered.
TEST_P(TilePyramids, OneThatAServerFailsToGiveTakesNoOtherWithIt) {
    RELJEF_NEED_NGINX();
    test::Nginx server(folder_.path(), "location /6/33/23.png { return 404; }"
                                       "location /6/34/22.png { return 500; }");
    const auto tiles = TileSet::open(GetParam() + server.url("{z:6}/{x}/{y}.png"));
    ASSERT_TRUE(tiles) << tiles.error().message;
    TileTerrainOptions options;
    options.area = web_tiles_area(name());
    const auto terrain = tiles->terrain(options);
    ASSERT_TRUE(terrain) << terrain.error().message;
    EXPECT_EQ(terrain->heightfield.void_count, 3U * 256U * 256U);
    ASSERT_EQ(terrain->errors.size(), 1U);
    EXPECT_THAT(terrain->errors.front(), HasSubstr("its tile 6/34/22 cannot be read"));
    server.serve_by("");
    expect_heights(*tiles);
}

TEST_P(TilePyramids, OneThatIsMovedToThisMachineIsNotRead) {
    RELJEF_NEED_NGINX();
    test::Nginx server(folder_.path());
    const std::string tile = server.url("6/33/22.png");
    server.serve_by("location /6/34/22.png { return 302 " + tile + "; }");
    const auto tiles = TileSet::open(GetParam() + server.url("{z:6}/{x}/{y}.png"));
    ASSERT_TRUE(tiles) << tiles.error().message;
    const auto found = tiles->heights(std::vector{place_of_pixel(34 * 256 + 9, 22 * 256 + 9, 6)});
    EXPECT_EQ(found.answers.front().kind, HeightSample::Kind::in_void);
    ASSERT_EQ(found.errors.size(), 1U);
    EXPECT_THAT(found.errors.front().message, HasSubstr("its tile 6/34/22 cannot be read"));
}

TEST_P(TilePyramids, OneWithAPaletteIsTheHeightsOfItsColours) {
    const double height = height_at_pixel(33 * pixels_a_side, 22 * pixels_a_side);
    test::MadeRaster level =
        test::made_raster(pixels_a_side, pixels_a_side, [](int, int) { return 1; });
    const auto part = [&](int band) { return static_cast<short>(channel(height, band)); };
    level.palette = {{0, 0, 0, 255}, {part(0), part(1), part(2), 255}};
    level.type = GDT_Byte;
    level.format = "PNG";
    ASSERT_TRUE(test::write(level, folder_.path() / "6/33/22.png"));
    const auto tiles = TileSet::open(name());
    ASSERT_TRUE(tiles) << tiles.error().message;
    const auto found = tiles->heights(std::vector{place_of_pixel(33 * 256 + 9, 22 * 256 + 9, 6)});
    EXPECT_TRUE(found.errors.empty());
    EXPECT_EQ(found.answers.front().height, height);
}

TEST_P(TilePyramids, OfAFolderAreATerrainWhereTheyLie) {
    const auto area = web_tiles_area(name());
    ASSERT_TRUE(area);
    EXPECT_NEAR(area->west, place_of_pixel(33 * 256, 0.0, 6).y, 1e-12);
    EXPECT_NEAR(area->east, place_of_pixel(35 * 256 - 1, 0.0, 6).y, 1e-12);
    EXPECT_NEAR(area->north, place_of_pixel(0.0, 22 * 256, 6).x, 1e-12);
    EXPECT_NEAR(area->south, place_of_pixel(0.0, 24 * 256 - 1, 6).x, 1e-12);
    const auto tiles = TileSet::open(name());
    ASSERT_TRUE(tiles);
    TileTerrainOptions options;
    options.area = area;
    options.raster.memory_budget = std::size_t{16} << 20U;
    const auto terrain = tiles->terrain(options);
    ASSERT_TRUE(terrain) << terrain.error().message;
    EXPECT_EQ(terrain->heightfield.heights.cols(), 512);
    EXPECT_EQ(terrain->heightfield.heights.rows(), 512);
    EXPECT_EQ(terrain->heightfield.void_count, 256U * 256U);
    EXPECT_GE(terrain->heightfield.range.low, 500.0);
    EXPECT_LE(terrain->heightfield.range.high, 2500.0);
}

TEST_P(TilePyramids, OneThatIsDamagedTakesNoOtherWithIt) {
    const auto damaged = folder_.path() / "6/34/22.png";
    std::filesystem::resize_file(damaged, 400);
    const auto tiles = TileSet::open(name());
    ASSERT_TRUE(tiles) << tiles.error().message;
    TileTerrainOptions options;
    options.area = web_tiles_area(name());
    const auto terrain = tiles->terrain(options);
    ASSERT_TRUE(terrain) << terrain.error().message;
    EXPECT_EQ(terrain->heightfield.void_count, 2U * 256U * 256U);
    ASSERT_EQ(terrain->errors.size(), 1U);
    EXPECT_EQ(terrain->errors.front(),
              name().string() + ": its tile 6/34/22 cannot be read, a whole picture of heights in "
                                "red, green and blue was expected");
}

TEST_P(TilePyramids, OneWithManyCompressedTextsAsksForNoMemory) {
    const std::string whole = test::read_bytes(folder_.path() / "6/34/22.png");
    std::string text("\0\0\x1E\x48zTXt", 8); // 7752 bytes, which may be 8 MB of text
    text.resize(12 + 7752, 'x');
    std::string bytes = whole.substr(0, 33);
    for (int i = 0; i < 9; ++i) {
        bytes += text;
    }
    folder_.write("6/34/22.png", bytes + whole.substr(33));
    const auto tiles = TileSet::open(name());
    ASSERT_TRUE(tiles) << tiles.error().message;
    TileTerrainOptions options;
    options.area = web_tiles_area(name());
    const auto terrain = tiles->terrain(options);
    ASSERT_TRUE(terrain) << terrain.error().message;
    ASSERT_EQ(terrain->errors.size(), 1U);
    EXPECT_THAT(terrain->errors.front(), HasSubstr("its tile 6/34/22 cannot be read"));
}

TEST_P(TilePyramids, OneInGreyIsNoHeights) {
    test::MadeRaster grey = test::made_raster(pixels_a_side, pixels_a_side,
                                              [](int col, int row) { return (col + row) % 251; });
    grey.type = GDT_Byte;
    grey.format = "PNG";
    ASSERT_TRUE(test::write(grey, folder_.path() / "6/33/23.png"));
    const auto tiles = TileSet::open(name());
    ASSERT_TRUE(tiles) << tiles.error().message;
    TileTerrainOptions options;
    options.area = web_tiles_area(name());
    const auto terrain = tiles->terrain(options);
    ASSERT_TRUE(terrain) << terrain.error().message;
    EXPECT_EQ(terrain->heightfield.void_count, 2U * 256U * 256U);
    ASSERT_EQ(terrain->errors.size(), 1U);
    EXPECT_THAT(terrain->errors.front(), HasSubstr("its tile 6/33/23 "));
}

TEST_P(TilePyramids, TakeNoNameOfAFolderForATileThatCannotBe) {
    for (const char* name : {"6/0", "6/64", "6/2147483647", "6/33/64", "2026", "2147483647/0"}) {
        std::filesystem::create_directories(folder_.path() / name);
    }
    folder_.write("6/40.png", "no column of tiles");
    const auto area = web_tiles_area(name());
    ASSERT_TRUE(area);
    EXPECT_NEAR(area->west, place_of_pixel(33 * 256, 0.0, 6).y, 1e-12);
    EXPECT_NEAR(area->east, place_of_pixel(35 * 256 - 1, 0.0, 6).y, 1e-12);
    EXPECT_NEAR(area->south, place_of_pixel(0.0, 24 * 256 - 1, 6).x, 1e-12);
    const auto tiles = TileSet::open(name());
    ASSERT_TRUE(tiles) << tiles.error().message;
    expect_heights(*tiles);
}

TEST_P(TilePyramids, ThatAreNoneAreRefused) {
    const test::TemporaryFolder empty;
    const auto nothing = TileSet::open(GetParam() + empty.path().string());
    ASSERT_FALSE(nothing);
    EXPECT_THAT(nothing.error().message, HasSubstr("holds no tiles"));
    const auto missing = TileSet::open(GetParam() + (empty.path() / "nowhere").string());
    ASSERT_FALSE(missing);
    EXPECT_THAT(missing.error().message, HasSubstr("nowhere: is no folder"));
    for (const char* address :
         {"http://127.0.0.1/{z}/{x}.png", "http://127.0.0.1/{z:99}/{x}/{y}"}) {
        const auto bad = TileSet::open(std::string(GetParam()) + address);
        ASSERT_FALSE(bad);
        EXPECT_THAT(bad.error().message, HasSubstr("{x} and {y} was expected"));
    }
}

INSTANTIATE_TEST_SUITE_P(Encodings, TilePyramids, ::testing::Values("terrarium+", "terrain-rgb+"),
                         [](const auto& parameter) {
                             return std::string(parameter.index == 0 ? "terrarium" : "terrain_rgb");
                         });

TEST(RealTilePyramid, ATerrariumTileIsWhereItsNumbersSay) {
    RELJEF_NEED_DATA("natural/terrarium_z11_385_803.png");
    const test::TemporaryFolder folder;
    std::filesystem::create_directories(folder.path() / "11" / "385");
    std::filesystem::copy_file(test::data_path("natural/terrarium_z11_385_803.png"),
                               folder.path() / "11" / "385" / "803.png");
    const auto tiles = TileSet::open("terrarium+" + folder.path().string());
    ASSERT_TRUE(tiles) << tiles.error().message;
    const auto found =
        tiles->heights(std::vector{place_of_pixel(385 * 256 + 10, 803 * 256 + 20, 11)});
    EXPECT_EQ(found.answers.front().height,
              134 * 256 + 77 + 179 / 256.0 - 32768); // gdallocationinfo
}

TEST(WebTilesOfStrangers, InHugeBlocksAskForNoMemory) {
    const test::TemporaryFolder folder;
    const auto path = folder.path() / "0" / "0" / "0.png";
    std::filesystem::create_directories(path.parent_path());
    ASSERT_TRUE(test::write(
        test::SparseTiff{256, 256, 3, {"TILED=YES", "BLOCKXSIZE=20000", "BLOCKYSIZE=20000"}},
        path));
    const GdalMessages messages;
    const auto tiles = open_raster("terrarium+" + folder.path().string(), messages);
    ASSERT_TRUE(tiles) << tiles.error().message;
    std::vector<double> values(1);
    EXPECT_FALSE(read_window(*(*tiles)->GetRasterBand(1),
                             {{}, glm::ivec2(1), values.data(), glm::ivec2(1)}));
    EXPECT_THAT(messages.reason(), HasSubstr("is no picture of 256×256 pixels"));
}

} // namespace
} // namespace reljef::io
