#include "engine/io/imagery/imagery_set.h"

#include <array>
#include <cmath>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/parallel_for.h"
#include "engine/io/raster/crs_transform.h"
#include "tests/io/made_raster.h"
#include "tests/support/bytes_read.h"
#include "tests/support/process_state.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using test::MadeRaster;
using ::testing::HasSubstr;

constexpr const char* utm_31 = "EPSG:32631"; // its middle meridian is 3° east

/// A colour for each place: red by longitude, green by latitude.
glm::dvec2 color_of(glm::dvec2 degrees) {
    return {127.5 + 120.0 * std::sin(40.0 * degrees.x), 127.5 + 120.0 * std::cos(45.0 * degrees.y)};
}
/// How fast it changes at most, a metre.
constexpr double steepest = 120.0 * 45.0 / 77000.0;

/// `side`² pixels of `step` metres, in UTM, each of the colour of its middle.
MadeRaster picture_of_places(double west, double north, int cols, int rows, double step) {
    const auto to_degrees = CrsTransform::create(utm_31, wgs84_degrees).value();
    std::vector<glm::dvec2> places;
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
            places.emplace_back(west + (col + 0.5) * step, north - (row + 0.5) * step);
        }
    }
    to_degrees.apply(places);
    MadeRaster raster;
    raster.cols = cols;
    raster.rows = rows;
    for (const int channel : {0, 1}) {
        for (const glm::dvec2 place : places) {
            raster.values.push_back(std::round(color_of(place)[channel]));
        }
    }
    raster.values.resize(places.size() * 3, 40.0);
    raster.bands = 3;
    raster.type = GDT_Byte;
    raster.colors = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand};
    raster.crs = utm_31;
    raster.geotransform = {west, step, 0.0, north, 0.0, -step};
    return raster;
}

MadeRaster plain(double west, double north, int side, double step, double value) {
    MadeRaster raster = test::made_raster(side, side, [&](int, int) { return value; });
    raster.type = GDT_Byte;
    raster.crs = utm_31;
    raster.geotransform = {west, step, 0.0, north, 0.0, -step};
    return raster;
}

ImageryGround ground_in(const std::string& crs) {
    return crs == utm_31
               ? ImageryGround{crs, {480000.0, 80.0, 0.0, 5000000.0, 0.0, -80.0}, {99, 99}}
               : ImageryGround{crs, {2.78, 0.001, 0.0, 45.15, 0.0, -0.001}, {99, 99}};
}

ImageryWindow read(const ImagerySet& set, const TileGrid& grid) {
    return set.read(texels_at(grid));
}

class ImagerySets : public ::testing::Test {
protected:
    void add(const std::string& name, const MadeRaster& raster) const {
        ASSERT_TRUE(test::write(raster, folder_.path() / name));
    }
    [[nodiscard]] ImagerySet open(const std::vector<std::string>& names,
                                  const std::string& crs = wgs84_degrees,
                                  const ImagerySetOptions& options = {}) const {
        std::vector<std::filesystem::path> paths;
        for (const std::string& name : names) {
            paths.push_back(folder_.path() / name);
        }
        auto set = ImagerySet::open(paths, ground_in(crs), options);
        EXPECT_TRUE(set) << (set ? "" : set.error().message);
        return std::move(*set);
    }

    test::TemporaryFolder folder_;
};

// Degrees over UTM, with pixels of 20 m.
TEST_F(ImagerySets, ShowEachPlaceInItsColourToHalfAPixelAndTheWarpsError) {
    add("a.tif", picture_of_places(480000.0, 5000000.0, 400, 400, 20.0));
    const ImagerySet set = open({"a.tif"});
    const double step = 20.0 / 111200.0;
    const TileGrid grid{{2.79, 45.15}, {step, -step}, 257, 257};
    const auto pixels = set.finest_pixels_in(texels_at(grid));
    ASSERT_TRUE(pixels);
    EXPECT_NEAR(pixels->x, std::cos(glm::radians(45.1)), 0.005);
    EXPECT_NEAR(pixels->y, 1.0, 0.002);
    const ImageryWindow window = read(set, grid);
    EXPECT_TRUE(window.errors.empty());
    EXPECT_TRUE(window.whole);
    EXPECT_FALSE(window.has_more);
    // Bilinear over 20 m: an eighth of its square times the second derivative; the warp's error in
    // pixels; and a value's rounding, twice.
    const double second = 120.0 * 45.0 * 45.0 / (77000.0 * 77000.0);
    const double allowed = 20.0 * 20.0 / 4.0 * second + 0.05 * 20.0 * 2.0 * steepest + 1.0;
    int shown = 0;
    for (int row = 0; row < grid.rows; ++row) {
        for (int col = 0; col < grid.cols; ++col) {
            const Rgba8 texel = window.texels(col, row);
            const glm::dvec2 expected = color_of(grid.first + grid.step * glm::dvec2(col, row));
            if (texel.a == 255) {
                ++shown;
                ASSERT_NEAR(texel.r, expected.x, allowed) << col << "," << row;
                ASSERT_NEAR(texel.g, expected.y, allowed) << col << "," << row;
                ASSERT_EQ(texel.b, 40);
            }
        }
    }
    EXPECT_EQ(shown, 257 * 257);
}

TEST_F(ImagerySets, WithACommonEdgeHaveNoGapAndNoSeam) {
    add("west.tif", picture_of_places(480000.0, 5000000.0, 200, 400, 20.0));
    add("east.tif", picture_of_places(484000.0, 5000000.0, 200, 400, 20.0));
    const ImagerySet set = open({"."});
    EXPECT_EQ(set.size(), 2U);
    const double step = 7.0 / 111200.0;
    const TileGrid grid{{2.78, 45.12}, {step, -step}, 257, 257};
    const ImageryWindow window = read(set, grid);
    for (int row = 0; row < grid.rows; ++row) {
        for (int col = 0; col < grid.cols; ++col) {
            const Rgba8 texel = window.texels(col, row);
            ASSERT_EQ(texel.a, 255) << col << "," << row;
            // At the edge itself no pixel lies beyond: half of one farther than elsewhere.
            const glm::dvec2 expected = color_of(grid.first + grid.step * glm::dvec2(col, row));
            ASSERT_NEAR(texel.r, expected.x, 10.0 * 1.5 * steepest + 2.0) << col << "," << row;
        }
    }
}

TEST_F(ImagerySets, NeighboursShareTheTexelsOfTheirCommonEdge) {
    add("a.tif", picture_of_places(480000.0, 5000000.0, 400, 400, 20.0));
    const ImagerySet set = open({"a.tif"});
    const double step = 33.0 / 111200.0;
    const TileGrid west{{2.79, 45.12}, {step, -step}, 65, 65};
    TileGrid east = west;
    east.first.x += 64 * step;
    TileGrid south = west;
    south.first.y -= 64 * step;
    const Image a = read(set, west).texels;
    const Image b = read(set, east).texels;
    const Image c = read(set, south).texels;
    for (int i = 0; i < 65; ++i) {
        ASSERT_EQ(a(64, i), b(0, i)) << i;
        ASSERT_EQ(a(i, 64), c(i, 0)) << i;
    }
}

TEST_F(ImagerySets, TheFinerCountsAndWhereItIsTransparentTheNext) {
    add("coarse.tif", plain(480000.0, 5000000.0, 100, 80.0, 50.0));
    MadeRaster fine = plain(482000.0, 4998000.0, 400, 5.0, 200.0);
    fine.nodata = 0.0;
    for (int i = 0; i < 400 * 200; ++i) {
        fine.values[static_cast<std::size_t>(i)] = 0.0; // its northern half
    }
    add("fine.tif", fine);
    const ImagerySet set = open({"coarse.tif", "fine.tif"}, utm_31);
    const auto at = [&](double x, double y) {
        const TileGrid grid{{x, y}, {10.0, -10.0}, 2, 2};
        return read(set, grid).texels(0, 0);
    };
    EXPECT_EQ(at(483000.0, 4996500.0).r, 200);
    EXPECT_EQ(at(483000.0, 4997500.0).r, 50);
    EXPECT_EQ(at(481000.0, 4999000.0).r, 50);
    EXPECT_EQ(at(470000.0, 4999000.0).a, 0);
    EXPECT_TRUE(read(set, {{483000.0, 4996500.0}, {10.0, -10.0}, 2, 2}).has_more);
    EXPECT_FALSE(read(set, {{470000.0, 4996500.0}, {10.0, -10.0}, 2, 2}).has_more);
}

// Pixels of 20 m are a little more ground the nearer they are to the meridian.
TEST_F(ImagerySets, OfEquallyFineOnesTheNewerCounts) {
    add("a.tif", plain(480000.0, 5000000.0, 400, 20.0, 50.0));
    add("b.tif", plain(484000.0, 5000000.0, 400, 20.0, 200.0));
    const TileGrid both{{486000.0, 4997000.0}, {20.0, -20.0}, 2, 2};
    const auto now = std::filesystem::file_time_type::clock::now();
    for (const auto& [newer, older, expected] :
         {std::tuple("a.tif", "b.tif", 50), {"b.tif", "a.tif", 200}}) {
        std::filesystem::last_write_time(folder_.path() / newer, now);
        std::filesystem::last_write_time(folder_.path() / older, now - std::chrono::hours(1));
        EXPECT_EQ(read(open({"a.tif", "b.tif"}, utm_31), both).texels(0, 0).r, expected);
    }
}

TEST_F(ImagerySets, CoarseViewsReadTheOverviewThatIsJustFiner) {
    MadeRaster raster = plain(480000.0, 5000000.0, 2048, 4.0, 90.0);
    raster.options = {"TILED=YES", "BLOCKXSIZE=128", "BLOCKYSIZE=128"};
    raster.overviews = {2, 4, 8, 16};
    add("a.tif", raster);
    const ImagerySet set = open({"a.tif"}, utm_31);
    const std::size_t before = test::bytes_read();
    const ImageryWindow window = read(set, {{480032.0, 4999968.0}, {64.0, -64.0}, 127, 127});
    const std::size_t bytes = test::bytes_read() - before;
    EXPECT_EQ(window.texels(60, 60), (Rgba8{90, 90, 90, 255}));
    EXPECT_TRUE(window.has_more);
    // Of 4 MB the sixteenth part of each side is 16 kB; the file's head and its last block come
    // with it.
    EXPECT_LT(bytes, 150'000U);
    EXPECT_GT(bytes, 16'000U);
}

TEST_F(ImagerySets, WhatWouldTakeTooLongWithoutOverviewsIsLeftOutAndSaid) {
    folder_.write("huge.vrt", test::stretched_vrt("part.tif", {.step = 1.0, .type = "Byte"}));
    add("part.tif", plain(0.0, 0.0, 256, 1.0, 77.0));
    const ImagerySet set = open({"huge.vrt"}, utm_31);
    ASSERT_TRUE(set.missing_overviews());
    EXPECT_THAT(*set.missing_overviews(), HasSubstr("huge.vrt"));
    EXPECT_THAT(*set.missing_overviews(), HasSubstr("gdaladdo -r average "));
    const ImageryWindow far = read(set, {{300000.0, 5600000.0}, {512.0, -512.0}, 129, 129});
    EXPECT_FALSE(far.whole);
    EXPECT_EQ(far.texels(60, 60).a, 0);
    const ImageryWindow near = read(set, {{310000.0, 5590000.0}, {2.0, -2.0}, 129, 129});
    EXPECT_TRUE(near.whole);
    EXPECT_EQ(near.texels(60, 60).r, 77);
}

TEST_F(ImagerySets, AFileThatIsGoneIsAFaultAndTheNextOneShows) {
    add("coarse.tif", plain(480000.0, 5000000.0, 100, 80.0, 50.0));
    add("fine.tif", plain(480000.0, 5000000.0, 400, 20.0, 200.0));
    const ImagerySet set = open({"coarse.tif", "fine.tif"}, utm_31);
    std::filesystem::remove(folder_.path() / "fine.tif");
    const ImageryWindow window = read(set, {{483000.0, 4997000.0}, {20.0, -20.0}, 9, 9});
    ASSERT_EQ(window.errors.size(), 1U);
    EXPECT_THAT(window.errors.front().message, HasSubstr("fine.tif: does not exist"));
    EXPECT_FALSE(window.whole);
    EXPECT_EQ(window.texels(4, 4).r, 50);
}

TEST_F(ImagerySets, AFileThatFailsAgainAndAgainIsPassedOverWithoutAFault) {
    add("coarse.tif", plain(480000.0, 5000000.0, 100, 80.0, 50.0));
    add("fine.tif", plain(480000.0, 5000000.0, 400, 20.0, 200.0));
    // Failures within one pause are one.
    const ImagerySet set =
        open({"coarse.tif", "fine.tif"}, utm_31, {.first_pause = std::chrono::milliseconds(0)});
    std::filesystem::remove(folder_.path() / "fine.tif");
    const TileGrid grid{{483000.0, 4997000.0}, {20.0, -20.0}, 9, 9};
    for (int i = 0; i < BackOff::max_attempts; ++i) {
        ASSERT_EQ(read(set, grid).errors.size(), 1U);
    }
    const ImageryWindow window = read(set, grid);
    EXPECT_TRUE(window.errors.empty());
    EXPECT_FALSE(window.whole);
    EXPECT_EQ(window.texels(4, 4).r, 50);
}

TEST_F(ImagerySets, AreNotOpenedOnceAStopIsAskedFor) {
    add("fine.tif", plain(480000.0, 5000000.0, 400, 20.0, 200.0));
    std::stop_source source;
    source.request_stop();
    ImagerySetOptions options;
    options.stop = source.get_token();
    const auto set =
        ImagerySet::open(std::vector{folder_.path() / "fine.tif"}, ground_in(utm_31), options);
    ASSERT_FALSE(set);
    EXPECT_THAT(set.error().message, HasSubstr("stopped"));
}

TEST_F(ImagerySets, KnowWhatIsWhite) {
    MadeRaster deep = plain(480000.0, 5000000.0, 40, 20.0, 300.0);
    deep.type = GDT_UInt16;
    deep.values[77] = 900.0;
    add("deep.tif", deep);
    EXPECT_DOUBLE_EQ(open({"deep.tif"}, utm_31).white(), 900.0);
}

TEST_F(ImagerySets, HaveMoreOnlyWhereAnImageIsSeen) {
    add("a.tif", plain(480000.0, 5000000.0, 400, 20.0, 200.0));
    add("tiny.tif", plain(500010.0, 4999990.0, 3, 2.0, 200.0));
    const ImagerySet set = open({"a.tif", "tiny.tif"}, utm_31);
    // West of it by less than the margin around its box; and where it begins.
    EXPECT_FALSE(read(set, {{479000.0, 4997000.0}, {100.0, -100.0}, 9, 9}).has_more);
    EXPECT_TRUE(read(set, {{479500.0, 4997000.0}, {100.0, -100.0}, 9, 9}).has_more);
    // One between the texels.
    const ImageryWindow window = read(set, {{499000.0, 5000500.0}, {500.0, -500.0}, 5, 5});
    EXPECT_TRUE(window.has_more);
}

TEST_F(ImagerySets, WithLittleMemoryShowTheSame) {
    add("a.tif", picture_of_places(480000.0, 5000000.0, 900, 900, 5.0));
    const double step = 8.0 / 111200.0;
    const TileGrid grid{{2.76, 45.14}, {step, -step}, 513, 513};
    const std::array paths{folder_.path() / "a.tif"};
    constexpr std::size_t megabyte = std::size_t{1} << 20U;
    const auto little =
        ImagerySet::open(paths, ground_in(wgs84_degrees), {.reading_memory = megabyte});
    const auto plenty =
        ImagerySet::open(paths, ground_in(wgs84_degrees), {.reading_memory = 256 * megabyte});
    ASSERT_TRUE(little && plenty);
    const Image expected = read(*plenty, grid).texels;
    const Image found = read(*little, grid).texels;
    int other_alpha = 0; // along the image's border
    for (int row = 0; row < grid.rows; ++row) {
        for (int col = 0; col < grid.cols; ++col) {
            if (found(col, row).a != expected(col, row).a) {
                ++other_alpha;
            } else if (expected(col, row).a != 0) {
                ASSERT_NEAR(found(col, row).r, expected(col, row).r, 2.0) << col << "," << row;
            }
        }
    }
    EXPECT_LE(other_alpha, grid.cols);
}

TEST_F(ImagerySets, OverviewsThatCannotBeOpenedAreLeftOut) {
    add("a.tif", plain(480000.0, 5000000.0, 512, 4.0, 90.0));
    add("half.tif", plain(480000.0, 5000000.0, 128, 16.0, 120.0));
    std::ofstream vrt(folder_.path() / "a.vrt");
    vrt << R"(<VRTDataset rasterXSize="512" rasterYSize="512"><SRS>EPSG:32631</SRS>)"
        << "<GeoTransform>480000, 4, 0, 5000000, 0, -4</GeoTransform>"
        << R"(<VRTRasterBand dataType="Byte" band="1"><SimpleSource>)"
        << R"(<SourceFilename relativeToVRT="1">a.tif</SourceFilename></SimpleSource>)"
        << R"(<Overview><SourceFilename relativeToVRT="1">gone.tif</SourceFilename>)"
        << "<SourceBand>1</SourceBand></Overview>"
        << R"(<Overview><SourceFilename relativeToVRT="1">half.tif</SourceFilename>)"
        << "<SourceBand>1</SourceBand></Overview></VRTRasterBand></VRTDataset>";
    vrt.close();
    const ImagerySet set = open({"a.vrt"}, utm_31);
    const Image texels = read(set, {{480500.0, 4999500.0}, {16.0, -16.0}, 9, 9}).texels;
    EXPECT_EQ(texels(4, 4).a, 255);
}

TEST_F(ImagerySets, OneWithoutAPlaceIsLeftOutAndTheOthersAreNotTheWhole) {
    add("a.tif", plain(480000.0, 5000000.0, 100, 80.0, 50.0));
    MadeRaster nowhere = plain(0.0, 0.0, 16, 1.0, 9.0);
    nowhere.crs = "";
    nowhere.geotransform = {};
    add("nowhere.tif", nowhere);
    const TileGrid grid{{470000.0, 4997000.0}, {20.0, -20.0}, 9, 9};
    EXPECT_TRUE(read(open({"a.tif"}, utm_31), grid).whole);
    EXPECT_FALSE(read(open({"a.tif", "nowhere.tif"}, utm_31), grid).whole);
}

// Texels of 40 m from west to east and 10 m from north to south, over pixels of 10 m.
TEST_F(ImagerySets, AreFilteredAsWideAsTheTexelsAlongEachSide) {
    MadeRaster lines = plain(480000.0, 5000000.0, 400, 10.0, 0.0);
    for (std::size_t i = 0; i < lines.values.size(); ++i) {
        lines.values[i] = (i / 400) % 2 == 0 ? 40.0 : 200.0; // a line a row
    }
    add("lines.tif", lines);
    const ImagerySet set = open({"lines.tif"}, utm_31);
    const Image texels = read(set, {{480215.0, 4999795.0}, {40.0, -10.0}, 9, 9}).texels;
    for (int row = 0; row < 9; ++row) {
        EXPECT_EQ(texels(4, row).r, row % 2 == 0 ? 40 : 200) << row;
    }
}

TEST_F(ImagerySets, WithoutAPlaceAreStretchedOverTheGround) {
    MadeRaster nowhere = test::made_raster(99, 99, [](int col, int) { return col; });
    nowhere.type = GDT_Byte;
    add("nowhere.tif", nowhere);
    const ImagerySet set = open({"nowhere.tif"}, utm_31);
    EXPECT_THAT(set.notes(), ::testing::ElementsAre(HasSubstr("nowhere.tif names no place")));
    const ImageryWindow window = read(set, {{480840.0, 4999160.0}, {80.0, -80.0}, 5, 5});
    for (int col = 0; col < 5; ++col) {
        EXPECT_EQ(window.texels(col, 2).r, 10 + col);
    }
}

// The middle of the terrain lies on the meridian of 180 degrees.
TEST_F(ImagerySets, InAProjectionAcrossTheAntimeridianKeepTheirResolution) {
    MadeRaster image = plain(690000.0, 5000000.0, 100, 1000.0, 90.0);
    image.crs = "EPSG:32660";
    add("a.tif", image);
    const ImageryGround ground{wgs84_degrees, {179.5, 0.01, 0.0, 45.0, 0.0, -0.01}, {100, 100}};
    const auto set = ImagerySet::open(std::vector{folder_.path() / "a.tif"}, ground);
    ASSERT_TRUE(set) << set.error().message;
    const TileGrid grid{{179.8, 44.8}, {0.01, -0.01}, 40, 20};
    const auto pixels = set->finest_pixels_in(texels_at(grid));
    ASSERT_TRUE(pixels);
    EXPECT_NEAR(pixels->x, 0.8, 0.1);
    EXPECT_NEAR(pixels->y, 1.1, 0.1);
    EXPECT_EQ(read(*set, grid).texels(30, 10).r, 90);
}

TEST_F(ImagerySets, GoOnAcrossTheAntimeridian) {
    MadeRaster world = test::made_raster(360, 180, [](int col, int) { return col / 2; });
    world.type = GDT_Byte;
    world.crs = "EPSG:4326";
    world.geotransform = {-180.0, 1.0, 0.0, 90.0, 0.0, -1.0};
    add("world.tif", world);
    const ImagerySet set = open({"world.tif"});
    const ImageryWindow window = read(set, {{175.5, 10.5}, {1.0, -1.0}, 10, 5});
    for (int col = 0; col < 10; ++col) {
        ASSERT_EQ(window.texels(col, 2).a, 255) << col;
        ASSERT_EQ(window.texels(col, 2).r, ((355 + col) % 360) / 2) << col;
    }
}

TEST_F(ImagerySets, AreReadBySeveralThreadsAtATime) {
    add("a.tif", picture_of_places(480000.0, 5000000.0, 100, 100, 80.0));
    const ImagerySet set = open({"a.tif"});
    const TileGrid grid{{2.79, 45.14}, {3e-4, -3e-4}, 65, 65};
    const Image expected = read(set, grid).texels;
    std::array<Image, 12> found;
    parallel_for(static_cast<int>(found.size()),
                 [&](int i) { found.at(static_cast<std::size_t>(i)) = read(set, grid).texels; });
    EXPECT_THAT(found, ::testing::Each(expected));
}

TEST_F(ImagerySets, LeaveNoFileOpen) {
    add("a.tif", plain(480000.0, 5000000.0, 100, 80.0, 50.0));
    const std::size_t before = test::open_files();
    {
        const ImagerySet set = open({"a.tif"}, utm_31);
        EXPECT_EQ(read(set, {{483000.0, 4997000.0}, {20.0, -20.0}, 9, 9}).texels(4, 4).r, 50);
        EXPECT_GT(test::open_files(), before);
    }
    EXPECT_EQ(test::open_files(), before);
}

} // namespace
} // namespace reljef::io
