#include <cstdio>

#include <gtest/gtest.h>

#include "tests/app/command_line.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

namespace reljef {
namespace {

// A 3″ raster around (0.5, 0.5) degrees, one sample void.
constexpr const char* dem_in_degrees =
    "ncols 3\nnrows 3\nxllcenter 10\nyllcenter 40\ncellsize 0.25\nNODATA_value -9999\n"
    "1 2 3\n4 5 6\n7 8 -9999\n";
constexpr const char* wgs84 =
    "GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,298.257223563]],"
    "PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]]";

class HeightCommand : public testing::Test {
protected:
    HeightCommand() {
        folder_.write("dem.prj", wgs84);
        dem_ = folder_.write("dem.asc", dem_in_degrees).string();
    }
    test::TemporaryFolder folder_;
    std::string dem_;
};

TEST_F(HeightCommand, prints_one_line_a_place) {
    const auto result =
        test::reljef({"height", dem_, "--quiet", "--at", "40.25,10.25", "--at", "40.375,10.125"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out, "40.25,10.25,5.000000\n40.375,10.125,3.000000\n");
}

TEST_F(HeightCommand, void_is_nan) {
    const auto result = test::reljef({"height", dem_, "--quiet", "--at", "40.01,10.49"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.out, "40.01,10.49,nan\n");
}

TEST_F(HeightCommand, outside_is_an_error) {
    test::expect_refusal(test::reljef({"height", dem_, "--quiet", "--at", "50,10"}), 1, {"50,10"});
}

TEST_F(HeightCommand, of_the_only_file_cut_short_is_one_sentence) {
    std::string rows = "ncols 300\nnrows 300\nxllcenter 10\nyllcenter 40\ncellsize 0.001\n";
    for (int i = 0; i < 300 * 200; ++i) {
        rows += "17 ";
    }
    folder_.write("cut.prj", wgs84);
    const std::string cut = folder_.write("cut.asc", rows).string();
    const auto result = test::reljef({"height", cut, "--at", "40.01,10.01"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.err,
              "reljef: " + cut + ": cannot be read: 60000 values found, 300×300 were expected\n");
}

TEST_F(HeightCommand, terrain_without_a_place_is_an_error) {
    test::expect_refusal(test::reljef({"height", "natural", "--at", "50,10"}), 1, {"natural"});
}

TEST(HeightCommandOnRealData, mont_blanc_stands_where_it_should) {
    RELJEF_NEED_DATA("natural/srtm3/N45E006.hgt");
    const auto result =
        test::reljef({"height", test::data_path("natural/srtm3/N45E006.hgt").string(), "--at",
                      "45.8326,6.8652"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    double height = 0.0;
    ASSERT_EQ(std::sscanf(result.out.c_str(), "45.8326,6.8652,%lf", &height), 1) << result.out;
    // 4,808 m (IGN); a 3″ sample averages the summit's dome.
    EXPECT_GT(height, 4600.0);
    EXPECT_LT(height, 4810.0);
}

} // namespace
} // namespace reljef
