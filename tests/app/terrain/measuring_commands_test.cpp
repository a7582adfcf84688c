// reljef profile and reljef viewshed.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/command_line.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

namespace reljef {
namespace {

using testing::HasSubstr;

constexpr const char* wgs84_text =
    "GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,298.257223563]],"
    "PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]]";

// A 65×65 raster at the equator, 0.001 degrees apart, with a wall of 500 m along 0.032 degrees east
// and a void in the north-west corner.
class MeasuringCommands : public testing::Test {
protected:
    MeasuringCommands() {
        std::string text = "ncols 65\nnrows 65\nxllcenter 0\nyllcenter 0\ncellsize 0.001\n"
                           "NODATA_value -9999\n";
        for (int i = 0; i < 65 * 65; ++i) {
            text += i == 0 ? "-9999 " : (i % 65 == 32 ? "500 " : "0 ");
        }
        folder_.write("wall.prj", wgs84_text);
        dem_ = folder_.write("wall.asc", text).string();
    }
    [[nodiscard]] std::string path(const std::string& name) const {
        return (folder_.path() / name).string();
    }
    test::TemporaryFolder folder_;
    std::string dem_;
};

TEST_F(MeasuringCommands, ProfileIsCsvWithBothEnds) {
    const auto result = test::reljef(
        {"profile", dem_, "--from", "0.032,0.010", "--to", "0.032,0.054", "--step", "103"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, testing::StartsWith("distance,latitude,longitude,height\n"
                                                "0.000,0.032000000,0.010000000,0.000\n"));
    EXPECT_THAT(result.out, HasSubstr(",0.054000000,0.000\n"));
    EXPECT_THAT(result.out, HasSubstr(",500.000\n")) << "the middle is a point";
    // 0.044 degrees of the equator are 4898.06 m: 48 steps.
    EXPECT_THAT(result.err, HasSubstr("4898.1 m along the geodesic"));
    EXPECT_THAT(result.err, HasSubstr("climb 500.0 m, descent 500.0 m"));
}

TEST_F(MeasuringCommands, ProfileBesideTheTerrainAndInVoids) {
    const auto partly =
        test::reljef({"profile", dem_, "--from", "0.064,0.0", "--to", "0.064,-0.001"});
    ASSERT_EQ(partly.exit_code, 0) << partly.err;
    EXPECT_THAT(partly.out, HasSubstr(",nan\n"));
    EXPECT_THAT(partly.err, HasSubstr("points without a height"));
    test::expect_refusal(test::reljef({"profile", dem_, "--from", "10,10", "--to", "11,11"}), 1,
                         {"10,10", "11,11", "beside"});
    test::expect_refusal(test::reljef({"profile", dem_, "--from", "nan,10", "--to", "11,11"}), 2,
                         {"--from", "nan,10"});
    test::expect_refusal(test::reljef({"profile", dem_, "--from", "91,10", "--to", "11,11"}), 2,
                         {"--from", "91,10"});
    test::expect_refusal(
        test::reljef({"profile", dem_, "--from", "0,0", "--to", "0.01,0.01", "--step", "1e-9"}), 1,
        {"points"});
    test::expect_refusal(test::reljef({"profile", "natural", "--from", "0,0", "--to", "0,1"}), 1,
                         {"natural"});
}

TEST_F(MeasuringCommands, ProfileOverTheTerrainIsRefused) {
    const std::string before = test::read_bytes(dem_);
    test::expect_refusal(test::reljef({"profile", dem_, "--from", "0.032,0.010", "--to",
                                       "0.032,0.054", "-o", path("./wall.asc")}),
                         2, {"-o", "wall.asc", "TERRAIN"});
    EXPECT_EQ(test::read_bytes(dem_), before);
}

TEST_F(MeasuringCommands, ViewshedBehindAWallIsHidden) {
    const auto result =
        test::reljef({"viewshed", dem_, "--from", "0.032,0.010,10", "-o", path("seen.tif")});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("% of the terrain is visible"));
    const auto at = [&](const std::string& place) {
        const auto asked = test::reljef({"height", path("seen.tif"), "--quiet", "--at", place});
        EXPECT_EQ(asked.exit_code, 0) << asked.err;
        return asked.out;
    };
    EXPECT_EQ(at("0.032,0.020"), "0.032,0.02,255.000000\n");
    EXPECT_EQ(at("0.032,0.032"), "0.032,0.032,255.000000\n") << "the top";
    EXPECT_EQ(at("0.032,0.040"), "0.032,0.04,0.000000\n");
    EXPECT_EQ(at("0.064,0.000"), "0.064,0,nan\n") << "a void";
    const auto tall = test::reljef({"viewshed", dem_, "--from", "0.032,0.010,10", "--target-height",
                                    "2000", "-o", path("seen.png")});
    EXPECT_EQ(tall.exit_code, 0) << tall.err;
    EXPECT_THAT(tall.err, HasSubstr("100.00 % of the terrain is visible"));
    EXPECT_TRUE(std::filesystem::exists(path("seen.png")));
}

TEST_F(MeasuringCommands, ViewshedFromNowhereWritesNothing) {
    for (const char* from : {"10,10", "0.064,0"}) {
        test::expect_refusal(
            test::reljef({"viewshed", dem_, "--from", from, "-o", path("none.tif")}), 1,
            {"--from", from});
    }
    for (const char* from : {"nan,0", "0.03,0.03,-5", "0.03", "0.03,0.03,1,2", "91,0"}) {
        test::expect_refusal(
            test::reljef({"viewshed", dem_, "--from", from, "-o", path("none.tif")}), 2,
            {"--from"});
    }
    test::expect_refusal(test::reljef({"viewshed", test::small_terrain(folder_, "natural"),
                                       "--from", "0,0", "-o", path("none.tif")}),
                         1, {"no place on Earth"});
    test::expect_refusal(
        test::reljef({"viewshed", dem_, "--from", "0.03,0.03", "-o", path("none.xyz")}), 2,
        {"-o", "none.xyz"});
    test::expect_refusal(test::reljef({"viewshed", dem_, "--from", "0.03,0.03", "-o", dem_}), 2,
                         {"-o"});
    EXPECT_FALSE(std::filesystem::exists(path("none.tif")));
}

} // namespace
} // namespace reljef
