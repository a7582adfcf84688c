#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/command_line.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

namespace reljef {
namespace {

TEST(InfoCommand, generated_terrain) {
    RELJEF_RELEASE_ONLY("the generators have tests of their own");
    const auto result = test::reljef({"info", "natural", "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto info = nlohmann::json::parse(result.out);
    EXPECT_EQ(info["cols"], 1025);
    EXPECT_EQ(info["rows"], 1025);
    EXPECT_TRUE(info["crs"].is_null());
    EXPECT_EQ(info["voids"], 0);
    EXPECT_GT(info["height_range"]["high_m"], info["height_range"]["low_m"]);
}

TEST(InfoCommand, real_tile) {
    RELJEF_NEED_DATA("natural/srtm3/N49E001.hgt");
    const auto result =
        test::reljef({"info", test::data_path("natural/srtm3/N49E001.hgt").string(), "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto info = nlohmann::json::parse(result.out);
    EXPECT_EQ(info["cols"], 1201);
    EXPECT_EQ(info["type"], "Int16");
    EXPECT_EQ(info["crs"]["code"], "EPSG:4326");
    EXPECT_EQ(info["voids"], 19088);
    EXPECT_EQ(info["height_range"]["low_m"], -16.0);
    EXPECT_EQ(info["height_range"]["high_m"], 256.0);
    EXPECT_NEAR(info["extent"]["south"], 49.0, 1e-9);
    EXPECT_NEAR(info["extent"]["east"], 2.0, 1e-9);
}

TEST(InfoCommand, feet_are_not_metres) {
    RELJEF_NEED_DATA("urban/annarbor/test_dsm.tif");
    const auto result =
        test::reljef({"info", test::data_path("urban/annarbor/test_dsm.tif").string(), "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto info = nlohmann::json::parse(result.out);
    EXPECT_NEAR(info["spacing"]["x_m"], 2.0 * 0.3048, 1e-5);
    EXPECT_NEAR(info["height_range"]["high_m"], 300.34, 0.01);
}

TEST(InfoCommand, TheExtentOfARasterAroundAPoleHasAllMeridians) {
    const test::TemporaryFolder folder;
    folder.write("pole.prj",
                 R"(PROJCS["polar",GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",)"
                 R"(SPHEROID["WGS_1984",6378137.0,298.257223563]],PRIMEM["Greenwich",0.0],)"
                 R"(UNIT["Degree",0.0174532925199433]],PROJECTION["Stereographic_South_Pole"],)"
                 R"(PARAMETER["False_Easting",0.0],PARAMETER["False_Northing",0.0],)"
                 R"(PARAMETER["Central_Meridian",0.0],PARAMETER["Standard_Parallel_1",-71.0],)"
                 R"(UNIT["Meter",1.0]])");
    const auto dem = folder.write("pole.asc", "ncols 4\nnrows 4\nxllcenter -150000\n"
                                              "yllcenter -150000\ncellsize 100000\n"
                                              "1 2 3 4 1 2 3 4 1 2 3 4 1 2 3 4 ");
    const auto result = test::reljef({"info", dem.string(), "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto extent = nlohmann::json::parse(result.out)["extent"];
    EXPECT_EQ(extent["south"], -90.0);
    EXPECT_EQ(extent["west"], -180.0);
    EXPECT_EQ(extent["east"], 180.0);
    EXPECT_NEAR(extent["north"], -88.04, 0.02); // of a corner
}

TEST(InfoCommand, text_names_the_essentials) {
    const auto result = test::reljef({"info", "urban"});
    ASSERT_EQ(result.exit_code, 0);
    for (const char* word : {"urban", "1024 x 1024", "spacing", "heights", "voids", "memory"}) {
        EXPECT_NE(result.out.find(word), std::string::npos) << word;
    }
}

TEST(InfoCommand, MillimetresAndLessHaveDigits) {
    const test::TemporaryFolder folder;
    const auto dem = folder.write("a.asc", "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\n"
                                           "cellsize 1e-06\n0 1e-05 2e-05\n0 1e-05 3e-05\n");
    const auto result = test::reljef({"info", dem.string()});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find("spacing  1e-06 x 1e-06 m"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("heights  0.00 to 3e-05 m"), std::string::npos) << result.out;
}

TEST(InfoCommand, the_gallery_names_its_models_and_their_tiles) {
    const auto mixed = nlohmann::json::parse(test::reljef({"info", "gallery", "--json"}).out);
    ASSERT_EQ(mixed["models"].size(), 8U);
    EXPECT_EQ(mixed["models"][0]["name"], "plane");
    EXPECT_EQ(mixed["models"][0]["textures"], "brick");
    const auto text = test::reljef({"info", "gallery", "--textures", "rock"});
    ASSERT_EQ(text.exit_code, 0) << text.err;
    EXPECT_NE(text.out.find("torus, with the detail texture rock"), std::string::npos);
}

TEST(InfoCommand, AVirtualRasterReadsNothingOutsideItsFolderUnlessAllowed) {
    const test::TemporaryFolder folder;
    folder.write("dem.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 30\n1 2\n3 4\n");
    const std::string path =
        folder
            .write("sub/a.vrt", R"(<VRTDataset rasterXSize="2" rasterYSize="2"><VRTRasterBand )"
                                R"(dataType="Float32" band="1"><SimpleSource><SourceFilename )"
                                R"(relativeToVRT="1">../dem.asc</SourceFilename></SimpleSource>)"
                                "</VRTRasterBand></VRTDataset>")
            .string();
    test::expect_refusal(test::reljef({"info", path}), 1, {path, "../dem.asc", "--allow-external"});
    test::expect_refusal(test::reljef({"height", path, "--at", "1,1"}), 1, {"--allow-external"});
    const auto allowed = test::reljef({"info", path, "--allow-external"});
    EXPECT_EQ(allowed.exit_code, 0) << allowed.err;
}

} // namespace
} // namespace reljef
