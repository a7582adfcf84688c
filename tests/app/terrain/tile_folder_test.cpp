// A folder of tiles in the program: info, height, render, and what it does about broken ones.
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/command_line.h"
#include "tests/support/temporary_folder.h"

namespace reljef {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class TileFolder : public testing::Test {
protected:
    TileFolder() {
        options_.environment["XDG_CACHE_HOME"] = (folder_.path() / "cache").string();
        options_.environment["LIBGL_ALWAYS_SOFTWARE"] = "1";
        tile("tiles/west.asc", 10.0, 1.0);
        tile("tiles/below/east.asc", 10.08, 9.0);
    }
    /// 9×9 samples 0.01° apart, from a longitude on; heights fall by 1 m a row from `top`.
    void tile(const std::string& name, double west, double top) const {
        std::string text = "ncols 9\nnrows 9\nxllcenter " + std::to_string(west) +
                           "\nyllcenter 40\ncellsize 0.01\nNODATA_value -9999\n";
        for (int row = 0; row < 9; ++row) {
            for (int col = 0; col < 9; ++col) {
                text += std::to_string(top == 9.0 && col == 0 ? 1.0 + row : top + row) + " ";
            }
            text += "\n";
        }
        folder_.write(name, text);
        folder_.write(name.substr(0, name.size() - 3) + "prj",
                      "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,"
                      "298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\","
                      "0.0174532925199433]]");
    }
    [[nodiscard]] test::ProgramResult run(std::vector<std::string> arguments) const {
        arguments.emplace_back("--quiet");
        return test::reljef(arguments, options_);
    }
    [[nodiscard]] std::string path(const std::string& name) const {
        return (folder_.path() / name).string();
    }

    test::TemporaryFolder folder_;
    test::ProgramOptions options_;
};

TEST_F(TileFolder, info_tells_the_tiles_and_their_sum) {
    const auto result = run({"info", path("tiles"), "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto info = nlohmann::json::parse(result.out);
    EXPECT_EQ(info["tiles"]["files"], 2);
    EXPECT_EQ(info["tiles"]["formats"]["AAIGrid"], 2);
    EXPECT_EQ(info["cols"], 17);
    EXPECT_EQ(info["rows"], 9);
    EXPECT_EQ(info["voids"], 0);
    EXPECT_NEAR(info["extent"]["east"], 10.16, 1e-9);
    EXPECT_TRUE(info["faults"].empty());
}

TEST_F(TileFolder, heights_come_from_the_tile_that_has_them) {
    const auto result = run({"height", path("tiles"), "--at", "40.08,10.01", "--at", "40.07,10.12",
                             "--at", "40.075,10.085"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out, "40.08,10.01,1.000000\n40.07,10.12,10.000000\n"
                          "40.075,10.085,5.500000\n");
}

TEST_F(TileFolder, many_places_are_read_from_a_file) {
    const std::string points =
        folder_.write("points.csv", "latitude,longitude\n40.08,10.01\n\n40.07, 10.12,name\n50,10\n")
            .string();
    const auto result = run({"height", path("tiles"), "--points", points});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out, "40.08,10.01,1.000000\n40.07, 10.12,10.000000\n50,10,nan\n");
    const std::string bad = folder_.write("bad.csv", "40.08,10.01\nhere\n").string();
    test::expect_refusal(run({"height", path("tiles"), "--points", bad}), 1,
                         {"--points: line 2: 'here' found"});
    test::expect_refusal(run({"height", path("tiles"), "--points", path("none.csv")}), 1,
                         {"none.csv"});
    test::expect_refusal(run({"height", path("tiles")}), 2, {"--points FILE was expected"});
}

TEST_F(TileFolder, a_broken_tile_is_left_out_told_and_shows_in_the_exit_status) {
    folder_.write("tiles/broken.tif", "II*");
    const auto result = test::reljef(
        {"render", path("tiles"), "-o", path("out.png"), "--size", "64x48", "--context", "osmesa"},
        options_);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, HasSubstr("left out: "));
    EXPECT_THAT(result.err, HasSubstr("broken.tif"));
    EXPECT_THAT(result.err,
                HasSubstr("1 of the files asked for could not be read and is left out"));
    EXPECT_GT(test::read_bytes(path("out.png")).size(), 100U);
    std::filesystem::remove(path("tiles/broken.tif"));
    const auto whole = run({"render", path("tiles"), "-o", path("out.png"), "--size", "64x48",
                            "--context", "osmesa", "--camera", "40.0,10.08,5000,0,-20"});
    EXPECT_EQ(whole.exit_code, 0) << whole.err;
}

// Of a file that could be the one that has the place.
TEST_F(TileFolder, height_and_info_tell_files_that_cannot_be_used) {
    folder_.write("tiles/N45E006.hgt", "");
    const auto told = [&](std::vector<std::string> arguments, const std::string& out) {
        const auto result = test::reljef(arguments, options_);
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_THAT(result.out, HasSubstr(out));
        EXPECT_THAT(result.err, HasSubstr("1 of the files asked for could not be read"));
        return result.err;
    };
    const std::string points = folder_.write("points.csv", "45.5,6.5\n40.08,10.01\n").string();
    EXPECT_THAT(
        told({"height", path("tiles"), "--points", points}, "45.5,6.5,nan\n40.08,10.01,1.000000\n"),
        HasSubstr("left out: "));
    EXPECT_THAT(told({"height", path("tiles"), "--at", "40.08,10.01"}, "1.000000"),
                HasSubstr("N45E006.hgt: is empty"));
    told({"info", path("tiles"), "--json"}, "N45E006.hgt: is empty");
    test::expect_refusal(run({"height", path("tiles"), "--at", "45.5,6.5"}), 1,
                         {"45.5,6.5", "1 of its files could not be read", "N45E006.hgt"});
}

TEST_F(TileFolder, height_keeps_to_the_area_and_takes_no_options_of_pictures) {
    const auto height = [&](const std::string& option, const std::string& value) {
        return run({"height", path("tiles"), "--at", "40.08,10.01", option, value});
    };
    EXPECT_EQ(height("--area", "40.07,-350,40.08,-349.98").out, "40.08,10.01,1.000000\n");
    test::expect_refusal(height("--area", "40,10,40.05,10.02"), 1,
                         {"40.08,10.01 found", "in its area"});
    test::expect_refusal(height("--geoid", "none"), 2, {"--geoid"});
}

// 201 samples a side, of which 1 MB holds every second.
TEST_F(TileFolder, info_tells_the_whole_where_memory_holds_averages) {
    std::string text = "ncols 201\nnrows 201\nxllcenter 10\nyllcenter 40\ncellsize 0.001\n";
    for (int i = 0; i < 201 * 201; ++i) {
        text += "5 ";
    }
    const std::string projection = test::read_bytes(path("tiles/west.prj"));
    for (const char* name : {"one/dem.asc", "one"}) {
        folder_.write("one/dem.asc", text);
        folder_.write("one/dem.prj", projection);
        const auto result = run({"info", path(name), "--memory", "1", "--json"});
        ASSERT_EQ(result.exit_code, 0) << result.err;
        const auto info = nlohmann::json::parse(result.out);
        EXPECT_EQ(info["cols"], 201) << name;
        EXPECT_EQ(info["rows"], 201);
        EXPECT_EQ(info["read"]["cols"], 100);
        EXPECT_EQ(info["read"]["reduction"], 2);
        EXPECT_NEAR(info["extent"]["south"], 40.0, 1e-9);
        EXPECT_NEAR(info["extent"]["north"], 40.2, 1e-9);
        EXPECT_NEAR(info["extent"]["west"], 10.0, 1e-9);
        EXPECT_NEAR(info["extent"]["east"], 10.2, 1e-9);
        EXPECT_NEAR(info["extent"]["height_m"].get<double>() / 200,
                    info["spacing"]["y_m"].get<double>(), 1e-6);
    }
}

TEST_F(TileFolder, area_and_gaps_are_for_folders) {
    const auto part = run({"info", path("tiles"), "--json", "--area", "40.02,10.03,40.05,10.06"});
    ASSERT_EQ(part.exit_code, 0) << part.err;
    const auto info = nlohmann::json::parse(part.out);
    EXPECT_EQ(info["cols"], 4); // 10.03 to 10.06
    EXPECT_EQ(info["tiles"]["files"], 1);
    EXPECT_EQ(info["tiles"]["formats"]["AAIGrid"], 1);
    EXPECT_EQ(info["notes"].dump().find("as one"), std::string::npos) << info["notes"];
    test::expect_refusal(run({"info", path("tiles"), "--area", "1,2,3,4"}), 1, {"has nothing"});
    test::expect_refusal(run({"info", path("tiles"), "--area", "3,2,1,4"}), 2,
                         {"--area: '3,2,1,4'"});
    test::expect_refusal(run({"info", "natural", "--gaps", "sea"}), 2, {"--gaps", "no folder"});
}

TEST_F(TileFolder, the_example_scene_shows_a_folder) {
    const auto example =
        std::filesystem::path(RELJEF_README).parent_path() / "terrains" / "example_tiles.toml";
    std::string text = test::read_bytes(example);
    const auto replace = [&](const std::string& from, const std::string& to) {
        const auto at = text.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        text.replace(at, from.size(), to);
    };
    replace("south = 45.0", "south = 39.0");
    replace("west = 6.0", "west = 9.0");
    replace("north = 46.0", "north = 41.0");
    replace("east = 7.5", "east = 11.0");
    const auto result = run({"info", folder_.write("scene.toml", text).string(), "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(nlohmann::json::parse(result.out)["cols"], 17);
}

TEST_F(TileFolder, a_track_is_flown_over_it) {
    const std::string track =
        folder_
            .write("track.geojson",
                   "{\"type\":\"FeatureCollection\",\"features\":["
                   "{\"type\":\"Feature\",\"properties\":{},\"geometry\":{\"type\":\"LineString\","
                   "\"coordinates\":[[10.02,40.02],[10.12,40.06]]}},"
                   "{\"type\":\"Feature\",\"properties\":{},\"geometry\":{\"type\":\"LineString\","
                   "\"coordinates\":[[10.12,40.02],[10.02,40.06]]}}]}")
            .string();
    const auto result = run({"render", path("tiles"), "--path", track, "--frames", "2", "-o",
                             path("f%d.png"), "--size", "64x48", "--context", "osmesa"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(test::read_bytes(path("f0.png")), test::read_bytes(path("f1.png")));
    EXPECT_EQ(result.err, "") << "nothing was raised";
    const auto told = test::reljef({"render", path("tiles"), "--path", track, "-o", path("f.png"),
                                    "--size", "64x48", "--context", "osmesa"},
                                   options_);
    EXPECT_THAT(told.err, HasSubstr("track.geojson: holds 2 lines, the first is flown"));
    const std::string empty = folder_.write("empty.gpx", "<gpx></gpx>").string();
    test::expect_refusal(
        run({"render", path("tiles"), "--path", empty, "-o", path("x.png"), "--context", "osmesa"}),
        1, {"empty.gpx"});
}

TEST_F(TileFolder, frames_that_are_raised_over_the_ground_are_told_once) {
    const std::string track =
        folder_
            .write("track.geojson", "{\"type\":\"LineString\",\"coordinates\":[[10.02,40.02,-50],"
                                    "[10.06,40.06,-50],[10.12,40.06,500]]}")
            .string();
    const auto result =
        test::reljef({"render", path("tiles"), "--path", track, "--frames", "5", "-o",
                      path("f%d.png"), "--size", "64x48", "--context", "osmesa"},
                     options_);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const auto first = result.err.find("of 5 frames would be under the ground");
    ASSERT_NE(first, std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("of 5 frames", first + 1), std::string::npos);
    EXPECT_THAT(result.err, HasSubstr("lifted by up to 5"));
}

TEST_F(TileFolder, a_path_file_below_the_ground_is_an_error_after_whole_pictures) {
    const std::string file =
        folder_
            .write("under.toml",
                   "[[key]]\ntime = 0\nlatitude = 40.05\nlongitude = 10.05\nheight = -80\n")
            .string();
    const std::vector<std::string> arguments{"render",    path("tiles"), "--path", file,
                                             "-o",        path("f.png"), "--size", "64x48",
                                             "--context", "osmesa"};
    const auto result = run(arguments);
    test::expect_refusal(result, 1, {"under.toml", "1 of 1 frames", "--allow-underground"});
    EXPECT_TRUE(std::filesystem::exists(path("f.png")));
    std::vector<std::string> allowed = arguments;
    allowed.push_back("--allow-underground");
    EXPECT_EQ(run(allowed).exit_code, 0);
}

} // namespace
} // namespace reljef
