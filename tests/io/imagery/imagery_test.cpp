#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>

#include <sys/resource.h>

#include <gdal_utils.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/imagery/rgb_image.h"
#include "engine/io/raster/raster.h"
#include "engine/io/terrain_file.h"
#include "tests/io/made_raster.h"
#include "tests/support/process_state.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

namespace reljef::io {
namespace {

using test::joined;
using test::made_raster;
using test::MadeRaster;
using ::testing::HasSubstr;

constexpr std::array<double, 6> utm{500000.0, 10.0, 0.0, 5100000.0, 0.0, -10.0};

int red_of(int col, int row) {
    return (col * 4 + row) % 256;
}
int green_of(int col, int row) {
    return (row * 4) % 256 + 0 * col;
}
int blue_of(int col, int row) {
    return (col + row) % 256;
}

MadeRaster picture(int cols, int rows) {
    MadeRaster raster = made_raster(cols, rows, red_of);
    const MadeRaster green = made_raster(cols, rows, green_of);
    const MadeRaster blue = made_raster(cols, rows, blue_of);
    raster.values.insert(raster.values.end(), green.values.begin(), green.values.end());
    raster.values.insert(raster.values.end(), blue.values.begin(), blue.values.end());
    raster.bands = 3;
    raster.type = GDT_Byte;
    raster.colors = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand};
    return raster;
}

MadeRaster flat(int cols, int rows) {
    return made_raster(cols, rows, [](int col, int) { return 100.0 + col; });
}

class Imagery : public ::testing::Test {
protected:
    [[nodiscard]] Result<terrain::Terrain> drape(const MadeRaster& heights, const MadeRaster& image,
                                                 RasterOptions options = {}) const {
        EXPECT_TRUE(test::write(heights, folder_.path() / "heights.tif"));
        EXPECT_TRUE(test::write(image, folder_.path() / "image.tif"));
        options.imagery = {folder_.path() / "image.tif"};
        return read_terrain(folder_.path() / "heights.tif", options);
    }

    test::TemporaryFolder folder_;
};

void expect_same(const Image& color, const MadeRaster& image) {
    ASSERT_EQ(color.cols(), image.cols);
    ASSERT_EQ(color.rows(), image.rows);
    for (int row = 0; row < color.rows(); ++row) {
        for (int col = 0; col < color.cols(); ++col) {
            const auto byte = [](int value) { return static_cast<std::uint8_t>(value); };
            const Rgba8 expected{byte(red_of(col, row)), byte(green_of(col, row)),
                                 byte(blue_of(col, row)), 255};
            ASSERT_EQ(color(col, row), expected) << col << "," << row;
        }
    }
}

TEST_F(Imagery, WithoutItThereIsNoColour) {
    ASSERT_TRUE(test::write(flat(9, 9), folder_.path() / "heights.tif"));
    const auto terrain = read_terrain(folder_.path() / "heights.tif");
    ASSERT_TRUE(terrain);
    EXPECT_TRUE(terrain->color.empty());
}

TEST_F(Imagery, OnTheSameGridItIsKeptToTheBit) {
    MadeRaster heights = flat(50, 30);
    MadeRaster image = picture(50, 30);
    for (MadeRaster* raster : {&heights, &image}) {
        raster->crs = "EPSG:32631";
        raster->geotransform = utm;
    }
    const auto terrain = drape(heights, image);
    ASSERT_TRUE(terrain) << terrain.error().message;
    expect_same(terrain->color, image);
}

TEST_F(Imagery, WithoutAPlaceItIsStretchedCornerOnCorner) {
    for (const auto& [cols, rows] : {std::pair(50, 30), std::pair(99, 59), std::pair(13, 40)}) {
        const MadeRaster image = picture(cols, rows);
        const auto terrain = drape(flat(50, 30), image);
        ASSERT_TRUE(terrain) << terrain.error().message;
        expect_same(terrain->color, image);
    }
}

TEST_F(Imagery, AFinerOneKeepsItsResolution) {
    MadeRaster heights = flat(26, 26);
    heights.crs = "EPSG:32631";
    heights.geotransform = utm;
    MadeRaster image = made_raster(130, 130, [](int col, int) { return col; });
    image.type = GDT_Byte;
    image.crs = "EPSG:32631";
    image.geotransform = {500000.0, 2.0, 0.0, 5100000.0, 0.0, -2.0};
    const auto terrain = drape(heights, image);
    ASSERT_TRUE(terrain) << terrain.error().message;
    ASSERT_EQ(terrain->color.cols(), 126); // 25 intervals of 5 pixels
    // the first sample lies at 5 m, the middle of image pixel 2
    EXPECT_EQ(terrain->color(0, 60).r, 2);
    EXPECT_EQ(terrain->color(125, 60).r, 127);
    EXPECT_EQ(terrain->color(100, 60).g, 102); // grey
}

TEST_F(Imagery, AGiantOneWithoutOverviewsIsNotReadForHours) {
    MadeRaster heights = flat(33, 33);
    heights.crs = "EPSG:32631";
    heights.geotransform = {300000.0, 2000.0, 0.0, 5600000.0, 0.0, -2000.0};
    ASSERT_TRUE(test::write(heights, folder_.path() / "heights.tif"));
    ASSERT_TRUE(test::write(picture(256, 256), folder_.path() / "part.tif"));
    folder_.write("huge.vrt", test::stretched_vrt("part.tif", {.step = 1.0, .type = "Byte"}));
    RasterOptions options;
    options.imagery = {folder_.path() / "huge.vrt"};
    const auto terrain = read_terrain(folder_.path() / "heights.tif", options);
    ASSERT_TRUE(terrain) << terrain.error().message;
    EXPECT_TRUE(terrain->color.empty());
    ASSERT_EQ(terrain->errors.size(), 1U);
    EXPECT_THAT(terrain->errors.front(),
                HasSubstr("huge.vrt: more than 2147483648 pixels would be read"));
    EXPECT_THAT(terrain->errors.front(), HasSubstr("'gdaladdo -r average "));
}

TEST_F(Imagery, InAnotherCrsItIsWarpedIntoPlace) {
    MadeRaster heights = flat(101, 101);
    heights.crs = "EPSG:4326";
    heights.geotransform = {3.0, 0.001, 0.0, 46.0, 0.0, -0.001};
    // UTM 31N with its central meridian at 3° east; grey grows with the northing
    MadeRaster image = made_raster(200, 250, [](int, int row) { return 255 - row; });
    image.type = GDT_Byte;
    image.crs = "EPSG:32631";
    image.geotransform = {495000.0, 100.0, 0.0, 5100000.0, 0.0, -100.0};
    const auto terrain = drape(heights, image);
    ASSERT_TRUE(terrain) << terrain.error().message;
    const Image& color = terrain->color;
    const glm::dvec2 scale = glm::dvec2(100.0) / glm::dvec2(color.cols() - 1, color.rows() - 1);
    for (int row = 2; row < color.rows() - 2; row += 7) {
        for (int col = 2; col < color.cols() - 2; col += 7) {
            if (color(col, row).a == 0) {
                continue;
            }
            const glm::dvec2 place = terrain->heightfield.georeference->geodetic.latitude_longitude(
                scale * glm::dvec2(col, row));
            // northing on and near the central meridian
            const double northing =
                0.9996 * geo::geodesic_distance({0.0, 3.0, 0.0}, {place.x, 3.0, 0.0});
            const double expected = 255.0 - ((5100000.0 - northing) / 100.0 - 0.5);
            ASSERT_NEAR(color(col, row).r, expected, 1.5) << place.x;
        }
    }
    EXPECT_GT(color(color.cols() / 2, color.rows() / 2).a, 0);
}

TEST_F(Imagery, WhereItEndsThereIsNothing) {
    MadeRaster heights = flat(100, 100);
    MadeRaster image = picture(40, 100);
    for (MadeRaster* raster : {&heights, &image}) {
        raster->crs = "EPSG:32631";
        raster->geotransform = utm;
    }
    const auto terrain = drape(heights, image);
    ASSERT_TRUE(terrain) << terrain.error().message;
    EXPECT_EQ(terrain->color(10, 50).a, 255);
    EXPECT_EQ(terrain->color(60, 50).a, 0);
    EXPECT_THAT(joined(terrain->notes), HasSubstr("imagery covers 40 %"));
}

TEST_F(Imagery, ElsewhereItIsAnError) {
    MadeRaster heights = flat(100, 100);
    heights.crs = "EPSG:32631";
    heights.geotransform = utm;
    MadeRaster image = picture(40, 100);
    image.crs = "EPSG:4326";
    image.geotransform = {-120.0, 0.001, 0.0, 35.0, 0.0, -0.001};
    const auto terrain = drape(heights, image);
    ASSERT_FALSE(terrain);
    EXPECT_THAT(terrain.error().message, HasSubstr("image.tif: shows nothing of the terrain"));
}

TEST_F(Imagery, FollowsATurnedRaster) {
    MadeRaster heights = flat(50, 30);
    heights.crs = "EPSG:32631";
    heights.geotransform = {500000.0, 10.0, 0.0, 5099700.0, 0.0, 10.0}; // south up
    MadeRaster image = picture(50, 30);
    image.crs = "EPSG:32631";
    image.geotransform = utm;
    const auto terrain = drape(heights, image);
    ASSERT_TRUE(terrain) << terrain.error().message;
    expect_same(terrain->color, image);
}

TEST_F(Imagery, FollowsAWindow) {
    RasterOptions options;
    options.window = RasterOptions::Window{10, 5, 21, 11};
    for (const bool placed : {false, true}) {
        MadeRaster heights = flat(50, 30);
        MadeRaster image = picture(50, 30);
        for (MadeRaster* raster : {&heights, &image}) {
            if (placed) {
                raster->crs = "EPSG:32631";
                raster->geotransform = utm;
            }
        }
        const auto terrain = drape(heights, image, options);
        ASSERT_TRUE(terrain) << terrain.error().message;
        ASSERT_EQ(terrain->color.cols(), 21);
        EXPECT_EQ(terrain->color(0, 0).r, red_of(10, 5));
        EXPECT_EQ(terrain->color(20, 10).b, blue_of(30, 15));
    }
}

TEST_F(Imagery, IsScaledDownToTheBudget) {
    RasterOptions options;
    options.memory_budget = 50 * 50 * bytes_per_sample * 2;
    const auto terrain = drape(flat(50, 50), picture(3000, 3000), options);
    ASSERT_TRUE(terrain) << terrain.error().message;
    const double bytes = static_cast<double>(terrain->color.size()) * 16.0 / 3.0;
    EXPECT_LE(bytes, static_cast<double>(options.memory_budget));
    EXPECT_GT(bytes, 0.2 * static_cast<double>(options.memory_budget));
}

TEST_F(Imagery, IsNeverLongerThanItsLimit) {
    const auto terrain = drape(flat(50, 50), picture(5000, 20));
    ASSERT_TRUE(terrain) << terrain.error().message;
    EXPECT_EQ(terrain->color.cols(), max_image_side);
}

TEST_F(Imagery, AlphaAndPalettesAndDeepGreyAreUnderstood) {
    MadeRaster grey = made_raster(4, 2, [](int col, int) { return col == 0 ? 0 : 30000; });
    grey.type = GDT_UInt16;
    const auto deep = drape(flat(4, 2), grey);
    ASSERT_TRUE(deep) << deep.error().message;
    EXPECT_EQ(deep->color(3, 1), (Rgba8{255, 255, 255, 255}));
    EXPECT_EQ(deep->color(0, 1), (Rgba8{0, 0, 0, 255}));

    MadeRaster indexed = made_raster(4, 2, [](int col, int) { return col % 2; });
    indexed.type = GDT_Byte;
    indexed.palette = {{10, 20, 30, 255}, {200, 100, 50, 255}};
    const auto palette = drape(flat(4, 2), indexed);
    ASSERT_TRUE(palette) << palette.error().message;
    EXPECT_EQ(palette->color(0, 0), (Rgba8{10, 20, 30, 255}));
    EXPECT_EQ(palette->color(3, 1), (Rgba8{200, 100, 50, 255}));

    MadeRaster with_alpha = picture(4, 2);
    with_alpha.bands = 4;
    with_alpha.colors.push_back(GCI_AlphaBand);
    with_alpha.values.insert(with_alpha.values.end(), {255, 255, 0, 0, 255, 255, 0, 0});
    const auto alpha = drape(flat(4, 2), with_alpha);
    ASSERT_TRUE(alpha) << alpha.error().message;
    EXPECT_EQ(alpha->color(0, 0).a, 255);
    EXPECT_EQ(alpha->color(3, 0).a, 0);
    EXPECT_EQ(alpha->color(1, 1).r, red_of(1, 1));
}

TEST_F(Imagery, BadFilesAreNamed) {
    ASSERT_TRUE(test::write(flat(9, 9), folder_.path() / "heights.tif"));
    RasterOptions options;
    options.imagery = {folder_.path() / "none.png"};
    const auto missing = read_terrain(folder_.path() / "heights.tif", options);
    ASSERT_FALSE(missing);
    EXPECT_THAT(missing.error().message, HasSubstr("none.png: does not exist"));
    options.imagery = {folder_.write("text.png", "not a picture")};
    const auto text = read_terrain(folder_.path() / "heights.tif", options);
    ASSERT_FALSE(text);
    EXPECT_THAT(text.error().message, HasSubstr("text.png"));
}

TEST_F(Imagery, AmongPlacedOnesOneWithoutAPlaceIsLeftOutAndAloneItIsStretchedBothSaid) {
    MadeRaster heights = flat(50, 30);
    MadeRaster image = picture(50, 30);
    ASSERT_TRUE(test::write(image, folder_.path() / "nowhere.tif"));
    for (MadeRaster* raster : {&heights, &image}) {
        raster->crs = "EPSG:32631";
        raster->geotransform = utm;
    }
    ASSERT_TRUE(test::write(heights, folder_.path() / "heights.tif"));
    ASSERT_TRUE(test::write(image, folder_.path() / "image.tif"));
    RasterOptions options;
    options.imagery = {folder_.path() / "nowhere.tif", folder_.path() / "image.tif"};
    const auto both = read_terrain(folder_.path() / "heights.tif", options);
    ASSERT_TRUE(both) << both.error().message;
    expect_same(both->color, image);
    EXPECT_THAT(both->notes, testing::Contains(HasSubstr("nowhere.tif names no place on Earth")));
    options.imagery.pop_back();
    const auto alone = read_terrain(folder_.path() / "heights.tif", options);
    ASSERT_TRUE(alone) << alone.error().message;
    EXPECT_THAT(alone->notes, testing::Contains(HasSubstr("nowhere.tif names no place")));
}

TEST_F(Imagery, HeightsAreNoPictureWhetherAloneOrInAFolder) {
    ASSERT_TRUE(test::write(flat(9, 9), folder_.path() / "heights.tif"));
    MadeRaster other = flat(9, 9);
    other.crs = "EPSG:32631";
    other.geotransform = utm;
    const auto images = folder_.path() / "images";
    std::filesystem::create_directory(images);
    ASSERT_TRUE(test::write(other, images / "dem.tif"));
    for (const auto& [name, said] :
         {std::pair(images / "dem.tif", "as heights are stored"), {images, "holds no image"}}) {
        RasterOptions options;
        options.imagery = {name};
        const auto terrain = read_terrain(folder_.path() / "heights.tif", options);
        ASSERT_FALSE(terrain);
        EXPECT_THAT(terrain.error().message, HasSubstr(said));
    }
}

TEST_F(Imagery, ACutFileIsAnErrorNotHalfAPicture) {
    MadeRaster image = picture(300, 300);
    ASSERT_TRUE(test::write(flat(300, 300), folder_.path() / "heights.tif"));
    ASSERT_TRUE(test::write(image, folder_.path() / "image.tif"));
    const std::string whole = test::read_bytes(folder_.path() / "image.tif");
    RasterOptions options;
    options.imagery = {folder_.write("cut.tif", whole.substr(0, whole.size() / 2))};
    const auto terrain = read_terrain(folder_.path() / "heights.tif", options);
    ASSERT_FALSE(terrain);
    EXPECT_THAT(terrain.error().message, HasSubstr("cut.tif"));
}

// Reading what is missing as zeros would take a minute.
TEST_F(Imagery, AGiantThatIsOnlyAHeaderIsRefusedAtOnce) {
    ASSERT_TRUE(test::write(flat(9, 9), folder_.path() / "heights.tif"));
    RasterOptions options;
    options.imagery = {folder_.write("vast.pgm", "P5\n100000 100000\n65535\nxx")};
    const auto terrain = read_terrain(folder_.path() / "heights.tif", options);
    ASSERT_FALSE(terrain);
    EXPECT_THAT(terrain.error().message, HasSubstr("vast.pgm"));
}

/// At most so many files more than are open now, for the scope.
class FewFiles {
public:
    explicit FewFiles(rlim_t more) {
        ::getrlimit(RLIMIT_NOFILE, &before_);
        rlimit few = before_;
        few.rlim_cur = more + test::open_files();
        ::setrlimit(RLIMIT_NOFILE, &few);
    }
    ~FewFiles() { ::setrlimit(RLIMIT_NOFILE, &before_); }
    FewFiles(const FewFiles&) = delete;
    FewFiles& operator=(const FewFiles&) = delete;

private:
    rlimit before_{};
};

TEST_F(Imagery, ThereMayBeMoreImagesThanTheSystemOpens) {
    MadeRaster heights = flat(64, 4);
    heights.crs = "EPSG:32631";
    heights.geotransform = utm;
    ASSERT_TRUE(test::write(heights, folder_.path() / "heights.tif"));
    RasterOptions options;
    for (int i = 0; i < 64; ++i) {
        MadeRaster column = made_raster(1, 4, [&](int, int) { return 2 * i; });
        column.type = GDT_Byte;
        column.crs = "EPSG:32631";
        column.geotransform = {500000.0 + 10.0 * i, 10.0, 0.0, 5100000.0, 0.0, -10.0};
        options.imagery.push_back(folder_.path() / ("i" + std::to_string(i) + ".tif"));
        ASSERT_TRUE(test::write(column, options.imagery.back()));
    }
    const FewFiles few(24);
    const auto terrain = read_terrain(folder_.path() / "heights.tif", options);
    ASSERT_TRUE(terrain) << terrain.error().message;
    EXPECT_EQ(joined(terrain->errors), "");
    EXPECT_EQ(terrain->color(3, 2).r, 6);
    EXPECT_EQ(terrain->color(60, 2).r, 120);
}

TEST_F(Imagery, WhatLiesElsewhereIsPassedOver) {
    MadeRaster heights = flat(20, 20);
    heights.crs = "EPSG:32631";
    heights.geotransform = utm;
    ASSERT_TRUE(test::write(heights, folder_.path() / "heights.tif"));
    MadeRaster here = picture(20, 20);
    here.crs = "EPSG:32631";
    here.geotransform = utm;
    ASSERT_TRUE(test::write(here, folder_.path() / "here.tif"));
    MadeRaster elsewhere = picture(400, 400); // finer
    elsewhere.crs = "EPSG:4326";
    elsewhere.geotransform = {40.0, 1e-5, 0.0, 10.0, 0.0, -1e-5};
    ASSERT_TRUE(test::write(elsewhere, folder_.path() / "elsewhere.tif"));
    RasterOptions options;
    options.imagery = {folder_.path() / "elsewhere.tif", folder_.path() / "here.tif"};
    const auto terrain = read_terrain(folder_.path() / "heights.tif", options);
    ASSERT_TRUE(terrain) << terrain.error().message;
    expect_same(terrain->color, here);
}

// Pixels of 10 m are 10.004 m and 9.996 m of ground, by how far they are from the meridian.
TEST_F(Imagery, OfEquallyFineOnesTheNewerCounts) {
    MadeRaster heights = flat(101, 101);
    heights.crs = "EPSG:4326";
    heights.geotransform = {3.0, 0.001, 0.0, 46.0, 0.0, -0.001};
    ASSERT_TRUE(test::write(heights, folder_.path() / "heights.tif"));
    RasterOptions options;
    const auto now = std::filesystem::file_time_type::clock::now();
    for (const auto& [name, west, value, age] :
         {std::tuple("a.tif", 495000.0, 50, 0), {"b.tif", 500000.0, 200, 1}}) {
        for (const bool turned : {false, true}) {
            MadeRaster image = made_raster(900, 900, [value = value](int, int) { return value; });
            image.type = GDT_Byte;
            image.crs = "EPSG:32631";
            image.geotransform = {west, 10.0, 0.0, 5095000.0, 0.0, -10.0};
            const auto path = folder_.path() / (turned ? "turned" : "straight") / name;
            std::filesystem::create_directories(path.parent_path());
            ASSERT_TRUE(test::write(image, path));
            std::filesystem::last_write_time(path,
                                             now - std::chrono::hours(turned ? 1 - age : age));
        }
    }
    for (const auto& [folder, expected] : {std::pair("straight", 50), {"turned", 200}}) {
        options.imagery = {folder_.path() / folder};
        const auto terrain = read_terrain(folder_.path() / "heights.tif", options);
        ASSERT_TRUE(terrain) << terrain.error().message;
        const Image& color = terrain->color;
        // 3.025° east and 45.97° north: both show it
        EXPECT_EQ(color(color.cols() / 4, 3 * color.rows() / 10).r, expected) << folder;
    }
}

TEST_F(Imagery, ThePairsOfTheTestDataFit) {
    struct Pair {
        const char* heights;
        const char* image;
        int cols;
        int rows;
    };
    for (const Pair& pair :
         {Pair{"natural/craterlake-elev-16bit-30m.tif", "natural/craterlake-imagery-30m.tif", 429,
               279},
          {"natural/sba_elev32_wgs84_512x512.tif", "natural/sba_rgb_wgs84_512x512.tif", 512, 512},
          {"natural/png16_height_1024.png", "natural/png16_height_albedo_labelgrid.png", 2048,
           2048},
          {"natural/irrlicht_terrain-heightmap.bmp", "natural/irrlicht_terrain-texture.jpg", 1024,
           1024}}) {
        RELJEF_NEED_DATA(pair.heights);
        RELJEF_NEED_DATA(pair.image);
        RasterOptions options;
        options.imagery = {test::data_path(pair.image)};
        const auto terrain = read_terrain(test::data_path(pair.heights), options);
        ASSERT_TRUE(terrain) << terrain.error().message;
        EXPECT_EQ(terrain->color.cols(), pair.cols);
        EXPECT_EQ(terrain->color.rows(), pair.rows);
    }
}

} // namespace
} // namespace reljef::io
