#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/command_line.h"
#include "tests/support/temporary_folder.h"

namespace reljef {
namespace {

using test::expect_refusal;

constexpr const char* small_dem = "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 10\n"
                                  "NODATA_value -9999\n1 2 3\n4 5 6\n7 8 9\n";

class BadInput : public testing::Test {
protected:
    // Renders a file with osmesa; the output must not appear.
    test::ProgramResult render(const std::string& terrain, std::vector<std::string> more = {}) {
        std::vector<std::string> arguments{"render", terrain, "-o",        picture(),
                                           "--size", "64x48", "--context", "osmesa"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        auto result = test::reljef(arguments);
        EXPECT_FALSE(std::filesystem::exists(picture()));
        return result;
    }
    std::string write(std::string_view name, std::string_view bytes) {
        return folder_.write(name, bytes).string();
    }
    std::string picture() { return (folder_.path() / "picture.png").string(); }

    test::TemporaryFolder folder_;
};

TEST_F(BadInput, missing_file) {
    expect_refusal(render((folder_.path() / "none.tif").string()), 1, {"none.tif"});
}

TEST_F(BadInput, no_sky) {
    const std::string dem = write("small.asc", small_dem);
    const auto with = [&](const char* option, const std::string& value) {
        return render(dem, {"--quiet", option, value});
    };
    expect_refusal(with("--sky", (folder_.path() / "none.png").string()), 1, {"none.png"});
    expect_refusal(with("--sky", dem), 1, {"small.asc"});
    expect_refusal(with("--sky-turn", "5"), 2, {"--sky-turn", "--sky FILE"});
    expect_refusal(with("--sky-turn", "nan"), 2, {"--sky-turn", "nan"});
    expect_refusal(with("--sky", picture()), 2, {"picture.png", "--sky"});
}

TEST_F(BadInput, unknown_name) {
    expect_refusal(render("atlantis"), 1, {"atlantis", "gallery, natural, urban"});
}

TEST_F(BadInput, empty_file) {
    expect_refusal(render(write("empty.tif", "")), 1, {"empty.tif"});
}

TEST_F(BadInput, not_a_raster) {
    expect_refusal(render(write("text.tif", "this is no raster, whatever its name says")), 1,
                   {"text.tif"});
}

TEST_F(BadInput, truncated_height_file) {
    expect_refusal(render(write("N45E006.hgt", std::string(1201 * 1201, '\1'))), 1,
                   {"N45E006.hgt"});
}

TEST_F(BadInput, truncated_ascii_grid) {
    expect_refusal(render(write("cut.asc", std::string(small_dem).substr(0, 80))), 1, {"cut.asc"});
}

TEST_F(BadInput, one_sample) {
    expect_refusal(
        render(write("one.asc", "ncols 1\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n5\n")), 1,
        {"one.asc", "1"});
}

TEST_F(BadInput, one_column) {
    expect_refusal(
        render(write("column.asc",
                     "ncols 1\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n5\n6\n7\n")),
        1, {"column.asc"});
}

TEST_F(BadInput, all_void) {
    expect_refusal(
        render(write("void.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n"
                                 "NODATA_value -1\n-1 -1\n-1 -1\n")),
        1, {"void.asc"});
}

TEST_F(BadInput, header_that_claims_a_hundred_thousand_squared_is_no_allocation) {
    const auto result = render(write("vast.pgm", "P5\n100000 100000\n65535\nxx"));
    expect_refusal(result, 1, {"vast.pgm"});
}

TEST_F(BadInput, walls_that_no_city_has) {
    for (const std::string& terrain : {std::string("natural"), write("dem.asc", small_dem)}) {
        const auto result =
            test::reljef({"render", terrain, "--walls", "stepped", "-o",
                          (folder_.path() / "out.png").string(), "--size", "64x48", "--quiet"});
        expect_refusal(result, 2, {"--walls", "urban"});
    }
    expect_refusal(test::reljef({"render", "urban", "--buildings", "meshes", "--walls", "stepped",
                                 "-o", (folder_.path() / "out.png").string()}),
                   2, {"--walls", "meshes"});
    expect_refusal(test::reljef({"render", "urban", "--walls", "round"}), 2,
                   {"--walls", "round", "straight", "stepped"});
}

TEST_F(BadInput, folder_without_tiles) {
    expect_refusal(render(folder_.path().string()), 1, {folder_.path().string()});
}

TEST_F(BadInput, tiles_of_heights_in_colours_may_lie_in_a_folder_without_a_path) {
    const auto result = test::reljef({"info", "terrarium+nowhere"});
    expect_refusal(result, 1, {"nowhere", "is no folder"});
    EXPECT_EQ(result.err.find("no such terrain"), std::string::npos) << result.err;
}

TEST_F(BadInput, output_folder_that_is_not_there) {
    const auto dem = write("dem.asc", small_dem);
    const auto result = test::reljef({"render", dem, "-o", "/nonexistent/picture.png", "--size",
                                      "64x48", "--context", "osmesa", "--quiet"});
    expect_refusal(result, 1, {"/nonexistent"});
}

TEST_F(BadInput, output_of_no_known_format) {
    const auto dem = write("dem.asc", small_dem);
    const auto output = (folder_.path() / "picture.xyz").string();
    const auto result = test::reljef(
        {"render", dem, "-o", output, "--size", "64x48", "--context", "osmesa", "--quiet"});
    expect_refusal(result, 2, {"picture.xyz", ".png or .jpg was expected"});
    EXPECT_EQ(folder_.names(), std::vector<std::string>{"dem.asc"});
}

TEST_F(BadInput, output_is_missing) {
    expect_refusal(test::reljef({"render", "natural"}), 2, {"-o"});
}

TEST_F(BadInput, many_frames_into_one_picture) {
    const auto dem = write("dem.asc", small_dem);
    expect_refusal(render(dem, {"--path", "orbit", "--frames", "3", "--quiet"}), 2, {"%04d"});
}

TEST_F(BadInput, path_that_is_not_there) {
    expect_refusal(render(write("dem.asc", small_dem), {"--path", "loop", "--quiet"}), 1,
                   {"--path", "loop", "orbit"});
}

TEST_F(BadInput, shader_that_does_not_compile) {
    const auto dem = write("dem.asc", small_dem);
    folder_.write("shaders/terrain/terrain.frag", "void main() { nonsense }\n");
    expect_refusal(render(dem, {"--shader-dir", (folder_.path() / "shaders").string(), "--quiet"}),
                   1, {"terrain.frag", "1"});
}

TEST_F(BadInput, scene_file_with_an_unknown_key) {
    const auto scene = write("scene.toml", "[terrain]\ngenerator = \"natural\"\nsise = 100\n");
    expect_refusal(render(scene), 1, {"scene.toml", "sise"});
}

TEST_F(BadInput, geodetic_camera_without_a_georeference) {
    const auto dem = write("dem.asc", small_dem);
    expect_refusal(render(dem, {"--camera", "45,6,1000,0,0", "--quiet"}), 1, {"--camera"});
}

TEST_F(BadInput, ellipsoid_without_a_georeference) {
    const auto dem = write("dem.asc", small_dem);
    expect_refusal(render(dem, {"--placement", "ellipsoid", "--quiet"}), 1, {"ellipsoid"});
}

TEST(ImpossibleContext, glfw_without_a_display_says_so) {
    test::ProgramOptions options;
    options.environment = {{"DISPLAY", std::nullopt}, {"WAYLAND_DISPLAY", std::nullopt}};
    const auto result =
        test::reljef({"render", "natural", "--context", "glfw", "-o", "never.png"}, options);
    expect_refusal(result, 1, {"glfw", "DISPLAY"});
}

// What is wrong with the arguments is exit status 2.
struct Misuse {
    std::vector<std::string> arguments;
    std::string part;
};

void PrintTo(const Misuse& usage_error, std::ostream* stream) {
    *stream << usage_error.part;
}

class Misused : public testing::TestWithParam<Misuse> {};

TEST_P(Misused, is_one_line_and_status_2) {
    expect_refusal(test::reljef(GetParam().arguments), 2, {GetParam().part});
}

INSTANTIATE_TEST_SUITE_P(
    Arguments, Misused,
    testing::Values(
        Misuse{{}, "--help"}, Misuse{{"fly"}, "verb 'fly'"}, Misuse{{"view", ""}, "after 'view'"},
        Misuse{{"render"}, "no TERRAIN found, one was expected"},
        Misuse{{"render", "natural", "-o"}, "--output: no value found, one was expected"},
        Misuse{{"render", "natural", "-o", "a.png", "-o", "b.png"},
               "--output: 2 values found, one was expected"},
        Misuse{{"render", "natural", "--truth", "--rays", "0", "-o", "a.png"},
               "--rays: '0' found, a whole number from 1 to 16 was expected"},
        Misuse{{"render", "natural", "--rays", "2", "-o", "a.png"},
               "--rays found without --truth, both were expected"},
        Misuse{{"render", "natural", "--truth", "--wireframe", "-o", "a.png"},
               "--wireframe found beside --truth, one of them was expected"},
        Misuse{{"help", "render", "natural"}, "'natural' found after 'render', nothing was"},
        Misuse{{"-V", "render"}, "'render' found after '-V', nothing was expected"},
        Misuse{{"render", "natural", "--technique", "magic", "-o", "a.png"}, "magic"},
        Misuse{{"render", "natural", "--technique", "polygons:lods=9", "-o", "a.png"}, "lods=9"},
        Misuse{{"render", "natural", "--technique", "polygons:lods=x", "-o", "a.png"}, "lods=x"},
        Misuse{{"render", "natural", "--technique", "polygons:lods=3", "--max-error", "1", "-o",
                "a.png"},
               "--max-error: --technique polygons:lods=3 found"},
        Misuse{{"render", "natural", "--technique", "polygons:error=2", "--max-error", "1", "-o",
                "a.png"},
               "--max-error: --technique polygons:error=2 found"},
        Misuse{{"render", "natural", "--truth", "--max-error", "1", "-o", "a.png"},
               "--max-error: found beside --truth"},
        Misuse{{"render", "natural", "--max-error", "0", "-o", "a.png"}, "--max-error: '0'"},
        Misuse{{"render", "natural", "--max-error", "-1", "-o", "a.png"}, "--max-error: '-1'"},
        Misuse{{"render", "natural", "--max-error", "nan", "-o", "a.png"}, "--max-error: 'nan'"},
        Misuse{{"render", "natural", "--max-error", "1", "--technique", "texture", "-o", "a.png"},
               "polygons was expected"},
        Misuse{{"render", "natural", "--technique", "texture:k=1", "-o", "a.png"}, "k"},
        Misuse{{"render", "natural", "--size", "0x768", "-o", "a.png"}, "0x768"},
        Misuse{{"render", "natural", "--size", "1000001x9", "-o", "a.png"}, "from 1 to 1000000"},
        Misuse{
            {"render", "natural", "--size", "16385x9", "-o", "a.jpg"},
            "--size: 16385x9 found; more than 16384 pixels a side need one .png or .tif picture"},
        Misuse{{"render", "natural", "--size", "16385x9", "--hit", "a.exr"}, "16384 pixels a side"},
        Misuse{{"render", "natural", "--size", "16385x9", "-o", "a.tif", "--truth"},
               "16384 pixels a side"},
        Misuse{{"view", "natural", "--size", "16385x9"}, "at most 16384 a side"},
        Misuse{{"render", "natural", "--size", "big", "-o", "a.png"}, "big"},
        Misuse{{"render", "natural", "--context", "vulkan", "-o", "a.png"}, "vulkan"},
        Misuse{{"render", "natural", "--samples", "3", "-o", "a.png"},
               "--samples: '3' found, one of 1, 2, 4, 8, 16 was expected"},
        Misuse{{"view", "natural", "--samples", "x"}, "--samples: 'x' found"},
        Misuse{{"render", "natural", "--fov", "180", "-o", "a.png"}, "180"},
        Misuse{{"render", "natural", "--fov", "nan", "-o", "a.png"}, "nan"},
        Misuse{{"render", "natural", "--eye", "1,2", "--look", "0,0,0", "-o", "a.png"}, "1,2"},
        Misuse{{"render", "natural", "--eye", "1,2,3", "-o", "a.png"}, "--look"},
        Misuse{{"render", "natural", "--camera", "95,6,1000,0,0", "-o", "a.png"}, "95"},
        Misuse{{"render", "natural", "--exaggeration", "0", "-o", "a.png"}, "0"},
        Misuse{{"render", "natural", "--exaggeration", "-1", "-o", "a.png"}, "-1"},
        Misuse{{"render", "natural", "--frames", "0", "-o", "a.png"}, "0"},
        Misuse{{"render", "natural", "--projection", "fisheye", "-o", "a.png"}, "fisheye"},
        Misuse{{"render", "natural", "--placement", "moon", "-o", "a.png"}, "moon"},
        Misuse{{"render", "natural", "--sun", "300,91", "-o", "a.png"}, "altitude 91"},
        Misuse{{"render", "natural", "--sun", "1e9,30", "-o", "a.png"}, "azimuth"},
        Misuse{{"render", "natural", "--sun", "2026-13-01T12:00", "-o", "a.png"}, "2026-13-01"},
        Misuse{{"render", "natural", "--sun", "2026-06-21T12:00", "-o", "a.png"},
               "no place on Earth"},
        Misuse{{"render", "natural", "--fov=", "-o", "a.png"}, "--fov="},
        Misuse{{"render", "natural", "--imagery", "", "-o", "a.png"}, "--imagery"},
        Misuse{{"render", "natural", "--fps", "1e-9", "-o", "a.png"}, "--fps"},
        Misuse{{"render", "natural", "-o", "%04d/a.png"}, "folder"},
        Misuse{{"render", "natural", "-o", "%d.mp4"}, "without a number"},
        Misuse{{"render", "natural", "-o", "%s.png"}, "%04d"},
        Misuse{{"render", "natural", "--frames", "3", "-o", "%d.png"}, "--path"},
        Misuse{{"render", "natural", "--stats", "--hit", "a.exr"}, "--stats"},
        Misuse{{"render", "natural", "--eye", "1,2,3", "--look", "1,2,3", "-o", "a.png"}, "--look"},
        Misuse{{"render", "natural", "--eye", "1e30,2,3", "--look", "1,2,3", "-o", "a.png"},
               "metres"},
        Misuse{{"render", "natural", "--camera", "1,2,1e30,0,0", "-o", "a.png"}, "height"},
        Misuse{{"render", "natural", "--technique", "auto", "--show", "choice", "--compare",
                "errors", "-o", "a.png"},
               "--compare"},
        Misuse{{"calibrate", "--size", "1x4000", "-o", "a.json"}, "320x240"},
        Misuse{{"calibrate", "--size", "9000x9000", "-o", "a.json"}, "4096"},
        Misuse{{"render", "natural", "--camera", "1,2,3,4,5", "--pose", "low", "-o", "a.png"},
               "--pose"},
        Misuse{{"render", "natural", "--camera", "1,2,3,4,5", "--path", "orbit", "-o", "a.png"},
               "--path"},
        Misuse{{"render", "natural", "--eye", "1,2,3", "--look", "1,2,4", "--path", "orbit", "-o",
                "a.png"},
               "--path"},
        Misuse{{"height", "natural", "--at", "45,6", "--imagery", "missing.tif"}, "--imagery"},
        Misuse{{"height", "natural"}, "--at"}, Misuse{{"height", "natural", "--at", "45"}, "45"}));

TEST_F(BadInput, NoOutputAppearsWhereAnotherCannot) {
    const auto hits = (folder_.path() / "hit.exr").string();
    const auto sheet = (folder_.path() / "sheet.xyz").string();
    const auto picture = (folder_.path() / "picture.png").string();
    struct Outputs {
        std::vector<std::string> options;
        int code;
    };
    for (const Outputs& outputs :
         {Outputs{{"--hit", hits, "-o", "/no/such/folder/a.png"}, 1},
          Outputs{{"-o", picture, "--contact-sheet", "/no/such/folder/a.png"}, 1},
          Outputs{{"-o", picture, "--contact-sheet", sheet}, 2},
          Outputs{{"-o", picture, "--hit", sheet}, 2},
          Outputs{{"--hit", hits, "--path", "orbit", "-o", folder_.path() / "%d.xyz"}, 2}}) {
        std::vector<std::string> arguments{"render", "natural", "--size", "64x48"};
        arguments.insert(arguments.end(), outputs.options.begin(), outputs.options.end());
        EXPECT_EQ(test::reljef(arguments).exit_code, outputs.code);
        EXPECT_TRUE(folder_.names().empty());
    }
}

TEST_F(BadInput, ShaderFolderThatIsNot) {
    test::expect_refusal(
        test::reljef({"render", "natural", "-o", picture(), "--shader-dir", "/no/such/folder"}), 2,
        {"--shader-dir", "/no/such/folder", "a folder was expected"});
}

TEST_F(BadInput, MapPoseBesideAPath) {
    test::expect_refusal(
        test::reljef({"render", "natural", "-o", picture(), "--pose", "map", "--path", "orbit"}), 2,
        {"--pose: map", "--path"});
}

} // namespace
} // namespace reljef
