#include "engine/io/formats/scene_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using ::testing::HasSubstr;

Result<SceneDescription> parse(const std::string& text) {
    return parse_scene(text, "scene.toml", "/data");
}

std::string error_of(const std::string& text) {
    const auto scene = parse(text);
    EXPECT_FALSE(scene) << text;
    return scene ? "" : scene.error().message;
}

TEST(SceneFile, ShareOfImageryIsAShare) {
    for (const char* const share : {"-0.1", "1.5", "nan"}) {
        EXPECT_THAT(
            error_of(std::string("[terrain]\nheights = \"a.tif\"\nimagery_share = ") + share),
            HasSubstr("imagery_share"));
    }
}

TEST(SceneFile, WallsAreOfTheCityOnly) {
    const auto stepped = parse("[terrain]\ngenerator = \"urban\"\nwalls = \"stepped\"\n");
    ASSERT_TRUE(stepped) << stepped.error().message;
    EXPECT_EQ(stepped->walls, building::CityWalls::stepped);
    const auto plain = parse("[terrain]\ngenerator = \"urban\"\n");
    ASSERT_TRUE(plain);
    EXPECT_EQ(plain->walls, building::CityWalls::straight);
    EXPECT_THAT(error_of("[terrain]\ngenerator = \"natural\"\nwalls = \"stepped\"\n"),
                HasSubstr("walls"));
    EXPECT_THAT(error_of("[terrain]\ngenerator = \"urban\"\nwalls = \"round\"\n"),
                HasSubstr("round"));
}

TEST(SceneFile, EveryKeyIsRead) {
    const auto scene = parse(R"(
name = "Mont Blanc"
[terrain]
heights = "alps.tif"
imagery = "/images/alps.jpg"
spacing = 30.0
height_scale = 0.5
height_offset = -10
exaggeration = 1.5
placement = "ellipsoid"
ramp = "colors.txt"
grain = 0.5
contours = 20
contour_labels = false
imagery_share = 0.4
[sun]
azimuth = 200
altitude = 12.5
occlusion = false
eye_dome = 0.25
[air]
visibility = 50000.0
turbidity = 3
base = "none"
sky = "dusk.jpg"
sky_turn = -30
[camera]
eye = [1, 2.5, 3]
look = [0, 0, 0]
)");
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->name, "Mont Blanc");
    EXPECT_EQ(scene->heights, "/data/alps.tif");
    EXPECT_EQ(scene->imagery, std::vector<std::filesystem::path>{"/images/alps.jpg"});
    EXPECT_EQ(scene->spacing, 30.0);
    EXPECT_EQ(scene->height_scale, 0.5);
    EXPECT_EQ(scene->height_offset, -10.0);
    EXPECT_EQ(scene->exaggeration, 1.5);
    EXPECT_EQ(scene->imagery_share, 0.4);
    EXPECT_EQ(scene->placement, "ellipsoid");
    EXPECT_EQ(scene->sun_azimuth, 200.0);
    EXPECT_EQ(scene->sun_altitude, 12.5);
    EXPECT_EQ(scene->visibility, 50000.0);
    const auto clear = parse("[terrain]\ngenerator = \"urban\"\n[air]\nvisibility = 0\n");
    ASSERT_TRUE(clear) << clear.error().message;
    EXPECT_EQ(clear->visibility, 0.0);
    EXPECT_FALSE(clear->sun_azimuth);
    EXPECT_FALSE(clear->sun_altitude);
    EXPECT_EQ(scene->ramp, "/data/colors.txt");
    EXPECT_FALSE(scene->hides_sky);
    EXPECT_EQ(scene->turbidity, 3.0);
    EXPECT_EQ(scene->sky, "/data/dusk.jpg");
    EXPECT_EQ(scene->sky_turn, -30.0);
    EXPECT_THAT(error_of("[terrain]\ngenerator = \"urban\"\n[air]\nsky_turn = 5"),
                HasSubstr("sky_turn"));
    EXPECT_EQ(scene->grain, 0.5);
    EXPECT_EQ(scene->contours, 20.0);
    EXPECT_FALSE(scene->contour_labels);
    EXPECT_EQ(scene->eye_dome, 0.25);
    EXPECT_EQ(scene->base, "none");
    EXPECT_EQ(parse("[terrain]\ngenerator = \"urban\"\n[air]\nbase = \"solid\"")->base, "solid");
    EXPECT_EQ(scene->eye, glm::dvec3(1.0, 2.5, 3.0));
    EXPECT_EQ(scene->target, glm::dvec3(0.0));
}

TEST(SceneFile, TheSunMayBeThatOfATime) {
    const auto scene =
        parse("[terrain]\ngenerator = \"urban\"\n[sun]\ntime = \"2026-06-21T06:15Z\"");
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_TRUE(scene->sun_time);
    EXPECT_EQ(scene->sun_time->hours, 6.25);
}

TEST(SceneFile, AGeneratorNeedsNothingElse) {
    const auto scene = parse("[terrain]\ngenerator = \"urban\"");
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->generator, "urban");
    EXPECT_EQ(scene->size, 1025);
    EXPECT_EQ(scene->seed, 1U);
    EXPECT_FALSE(scene->tileable);
    EXPECT_FALSE(scene->spacing);
    EXPECT_FALSE(scene->placement);
    EXPECT_FALSE(scene->eye);
    EXPECT_EQ(scene->exaggeration, 1.0);
    const auto full = parse("[terrain]\ngenerator = \"natural\"\nsize = 512\nseed = 4294967295\n"
                            "tileable = true\nspacing = 2");
    ASSERT_TRUE(full) << full.error().message;
    EXPECT_EQ(full->size, 512);
    EXPECT_EQ(full->seed, 4294967295U);
    EXPECT_TRUE(full->tileable);
}

TEST(SceneFile, OnlyTheGalleryHasTexturesAndATechnique) {
    const auto scene = parse("[terrain]\ngenerator = \"gallery\"\n[gallery]\ntextures = \"rock\"\n"
                             "technique = \"relief:n=8\"");
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->gallery_textures, "rock");
    EXPECT_EQ(scene->gallery_technique, "relief:n=8");
    EXPECT_EQ(parse("[terrain]\ngenerator = \"gallery\"")->gallery_textures, "mixed");
    EXPECT_THAT(error_of("[terrain]\ngenerator = \"urban\"\n[gallery]\ntextures = \"rock\""),
                HasSubstr("belongs to the generator gallery"));
}

TEST(SceneFile, ATileOfDetailHasAWidthAScaleAndATechnique) {
    const std::string urban = "[terrain]\ngenerator = \"urban\"\n";
    EXPECT_FALSE(parse(urban)->detail);
    const auto scene = parse(urban + "[detail]\ntextures = \"rock\"\nwidth = 7.5\nscale = 0.2\n"
                                     "technique = \"exact\"");
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->detail->textures, "rock");
    EXPECT_EQ(scene->detail->width, 7.5);
    EXPECT_EQ(scene->detail->scale, 0.2);
    EXPECT_EQ(scene->detail->technique, "exact");
    EXPECT_EQ(parse(urban + "[detail]\ntextures = \"rock\"")->detail->technique, "relief");
    EXPECT_THAT(error_of(urban + "[detail]\nwidth = 2"), HasSubstr("textures is missing"));
    for (const std::string width : {"0", "-1", "nan", "inf", "2e6"}) {
        EXPECT_THAT(error_of(urban + "[detail]\ntextures = \"rock\"\nwidth = " + width),
                    HasSubstr("width"));
    }
}

TEST(SceneFile, ATextureFolderIsRelativeToTheSceneFile) {
    const test::TemporaryFolder folder;
    folder.write("wall/color.txt", "");
    const auto scene =
        parse_scene("[terrain]\ngenerator = \"gallery\"\n[gallery]\ntextures = \"wall\"", "s.toml",
                    folder.path());
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->gallery_textures, (folder.path() / "wall").string());
}

TEST(SceneFile, BrokenTomlIsNamedWithItsLine) {
    EXPECT_THAT(error_of("[terrain]\ngenerator = \n"), HasSubstr("scene.toml:2: is no TOML"));
    EXPECT_THAT(error_of("[terrain\n"), HasSubstr("scene.toml:1"));
    EXPECT_THAT(error_of("a = 1\na = 2\n"), HasSubstr("is no TOML"));
    EXPECT_THAT(error_of(std::string("\0\x01\xff", 3)), HasSubstr("is no TOML"));
}

TEST(SceneFile, UnknownKeysAreRefusedWithTheKnownOnes) {
    EXPECT_THAT(
        error_of("[terrain]\ngenerator = \"urban\"\nsiez = 3\n"),
        HasSubstr("scene.toml:3: [terrain] siez is unknown, one of heights, generator, size"));
    EXPECT_THAT(error_of("[terrain]\ngenerator = \"urban\"\n[sea]\nlevel = 1\n"),
                HasSubstr("sea is unknown, one of name, terrain, area, gallery, detail, sun, air, "
                          "picture, camera"));
    EXPECT_THAT(error_of("[terrain]\ngenerator = \"urban\"\n[sun]\nheight = 3\n"),
                HasSubstr("[sun] height is unknown, one of azimuth, altitude"));
}

TEST(SceneFile, ExactlyOneSourceOfHeights) {
    EXPECT_THAT(error_of(""), HasSubstr("neither given, exactly one was expected"));
    EXPECT_THAT(error_of("[terrain]\nseed = 3"), HasSubstr("neither given"));
    EXPECT_THAT(error_of("[terrain]\ngenerator = \"urban\"\nheights = \"a.tif\""),
                HasSubstr("both given"));
    EXPECT_THAT(error_of("[terrain]\nheights = \"a.tif\"\nseed = 3"),
                HasSubstr("[terrain] seed is given, but it belongs to a generator"));
    EXPECT_THAT(error_of("[terrain]\ngenerator = \"urban\"\nimagery = \"a.png\""),
                HasSubstr("imagery is given"));
}

TEST(SceneFile, ValuesOutOfRangeAreNamedWithTheRange) {
    const std::string urban = "[terrain]\ngenerator = \"urban\"\n";
    const std::vector<std::pair<std::string, std::string>> cases{
        {urban + "size = 0", "size is 0, a whole number from 16 to 4096 was expected"},
        {urban + "size = 100000", "size is 100000"},
        {urban + "size = 99999999999999", "size is 99999999999999"},
        {urban + "size = 1e3", "size is 1000.0, a whole number"},
        {urban + "size = \"big\"", "size is 'big'"},
        {urban + "seed = -1", "seed is -1"},
        {urban + "seed = 4294967296", "seed is 4294967296"},
        {urban + "tileable = 1", "tileable is 1, true or false was expected"},
        {urban + "spacing = 0", "spacing is 0, a number from 1e-06 to 1000000 was expected"},
        {urban + "spacing = nan", "spacing is nan"},
        {urban + "exaggeration = inf", "exaggeration is inf"},
        {urban + "exaggeration = -2.0",
         "exaggeration is -2.0, a number above 0 and at most 1000000"},
        {urban + "placement = \"sphere\"", "is \"sphere\", one of plane, ellipsoid was expected"},
        {"[terrain]\ngenerator = \"moon\"",
         "is \"moon\", one of natural, urban, gallery was expected"},
        {"[terrain]\nheights = \"\"", "heights is ''"},
        {"[terrain]\nheights = 3", "heights is 3"},
        {"[terrain]\nheights = \"a.tif\"\nheight_scale = 0", "height_scale is 0"},
        {urban + "[sun]\naltitude = -91", "[sun] altitude is -91, a number from -90 to 90"},
        {urban + "[sun]\naltitude = 90.5", "altitude is 90.5"},
        {urban + "[sun]\nazimuth = 400", "azimuth is 400, a number from -360 to 360"},
        {urban + "[sun]\ntime = \"noon\"", "[sun] time is 'noon'"},
        {urban + "[sun]\ntime = \"2026-06-21T12:00\"\nazimuth = 3", "stands beside azimuth"},
        {urban + "[air]\nvisibility = nan", "[air] visibility is nan"},
        {urban + "[air]\nvisibility = -1", "[air] visibility is -1"},
        {urban + "[camera]\neye = [1, 2, 3]", "eye stands alone"},
        {urban + "[camera]\neye = [1, 2]\nlook = [1, 2, 3]", "three numbers"},
        {urban + "[camera]\neye = [1, 2, inf]\nlook = [1, 2, 3]", "three numbers"},
        {urban + "[camera]\neye = [1, 2, \"x\"]\nlook = [1, 2, 3]", "three numbers"},
        {urban + "[camera]\neye = [1, 2, 3]\nlook = [1, 2, 3]", "look is where eye is"},
        {urban + "[camera]\neye = [1, 2, 2e9]\nlook = [1, 2, 3]", "three numbers"},
        {"terrain = 3", "terrain is 3, a table [terrain] was expected"},
        {"[[terrain]]\ngenerator = \"urban\"", "terrain is a list [[terrain]], one table"}};
    for (const auto& [text, words] : cases) {
        const std::string message = error_of(text);
        EXPECT_THAT(message, HasSubstr("scene.toml:")) << text;
        EXPECT_THAT(message, HasSubstr(words)) << text;
    }
}

// The parser goes one call deeper for every part of a name and for every bracket.
TEST(SceneFile, EndlessNamesAndNestingAreRefusedBeforeTheStackEnds) {
    std::string parts = "a";
    for (int i = 0; i < 200'000; ++i) {
        parts += ".a";
    }
    const std::string open(50'000, '[');
    const std::string close(50'000, ']');
    for (const std::string& text :
         {parts + " = 1", "[" + parts + "]\nb = 1", "[[" + parts + "]]\nb = 1",
          "a = {" + parts + " = 1}", "\"#\"." + parts + " = 1",
          "'=' . \"\\\"\" . " + parts + " = 1", "a = [\"\"\"\n# \"\"\", {" + parts + " = 1}]",
          "a = " + open + close}) {
        EXPECT_THAT(error_of(text), HasSubstr("scene.toml:")) << text.substr(0, 30);
    }
}

TEST(SceneFile, DotsInTextsAndCommentsAreNoParts) {
    const std::string dots = "# 1.2.3.4" + std::string(500, '.') + "\n";
    const std::string text = dots + "name = \"" + std::string(500, '.') + "\"\n[terrain]\n" +
                             "generator = 'urban' " + dots + dots + "\n";
    const auto scene = parse_scene(text, "scene.toml", ".");
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->name.size(), 500U);
}

TEST(SceneFile, PathsStartFromTheSceneFilesFolderAndTheNameIsItsOwn) {
    const test::TemporaryFolder folder;
    const auto path = folder.write("my_alps.toml", "[terrain]\nheights = \"../dem/alps.tif\"\n");
    const auto scene = read_scene_file(path);
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->heights, folder.path() / "../dem/alps.tif");
    EXPECT_EQ(scene->name, "my_alps");
}

TEST(SceneFile, AddressesStayAndFoldersOfTilesLieBesideIt) {
    const auto heights_of = [](const std::string& name) {
        const auto scene =
            parse_scene("[terrain]\nheights = \"" + name + "\"", "scene.toml", "/scenes");
        return scene ? scene->heights.string() : scene.error().message;
    };
    EXPECT_EQ(heights_of("terrarium+tiles"), "terrarium+/scenes/tiles");
    EXPECT_EQ(heights_of("terrain-rgb+/maps/tiles"), "terrain-rgb+/maps/tiles");
    const std::string pattern = "terrain-rgb+https://host/{z}/{x}/{y}.png";
    EXPECT_EQ(heights_of(pattern), pattern);
    EXPECT_EQ(heights_of("https://host/dem.tif"), "https://host/dem.tif");
    EXPECT_EQ(heights_of("/vsizip/a.zip"), "/vsizip/a.zip");
}

TEST(SceneFile, ImageryIsOneTextOrAList) {
    const auto scene = parse_scene("[terrain]\nheights = \"a.tif\"\nimagery = [\"b.tif\", "
                                   "\"https://host/c.tif\"]",
                                   "scene.toml", "/scenes");
    ASSERT_TRUE(scene) << scene.error().message;
    const std::vector<std::filesystem::path> expected{"/scenes/b.tif", "https://host/c.tif"};
    EXPECT_EQ(scene->imagery, expected);
    EXPECT_THAT(error_of("[terrain]\nheights = \"a.tif\"\nimagery = [3]"),
                HasSubstr("texts in quotes were expected"));
    EXPECT_THAT(error_of("[terrain]\nheights = \"a.tif\"\nimagery = []"),
                HasSubstr("at least one text was expected"));
    EXPECT_THAT(error_of("[terrain]\nheights = \"a.tif\"\nimagery = 3"), HasSubstr("imagery is 3"));
}

TEST(SceneFile, MissingAndFoldersAreErrors) {
    const test::TemporaryFolder folder;
    const auto missing = read_scene_file(folder.path() / "none.toml");
    ASSERT_FALSE(missing);
    EXPECT_THAT(missing.error().message, HasSubstr("none.toml"));
    EXPECT_FALSE(read_scene_file(folder.path()));
}

TEST(SceneFile, TheOnesThatComeWithReljefAreGood) {
    const std::filesystem::path folder =
        std::filesystem::path(__FILE__).parent_path().parent_path().parent_path().parent_path() /
        "terrains";
    const auto natural = read_scene_file(folder / "natural.toml");
    ASSERT_TRUE(natural) << natural.error().message;
    EXPECT_EQ(natural->generator, "natural");
    EXPECT_EQ(natural->size, 1025);
    EXPECT_EQ(natural->seed, 1U);
    const auto urban = read_scene_file(folder / "urban.toml");
    ASSERT_TRUE(urban) << urban.error().message;
    EXPECT_EQ(urban->generator, "urban");
    EXPECT_EQ(urban->size, 1024);
    const auto example = read_scene_file(folder / "example_dem.toml");
    ASSERT_TRUE(example) << example.error().message;
    EXPECT_FALSE(example->heights.empty());
}

TEST(SceneFile, AnAreaHasAllItsFourSides) {
    const std::string folder = "[terrain]\nheights = \"tiles\"\ngaps = \"sea\"\n[area]\n";
    const auto scene =
        parse_scene(folder + "south = 45\nwest = 6\nnorth = 46\neast = 7.5\n", "s.toml", "data");
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_TRUE(scene->area);
    EXPECT_EQ(scene->area->east, 7.5);
    EXPECT_EQ(scene->gaps, "sea");
    for (const auto& [sides, sentence] :
         {std::pair("south = 45\nwest = 6\nnorth = 46\n", "east is missing"),
          std::pair("south = 46\nwest = 6\nnorth = 45\neast = 7\n", "north is not above south"),
          std::pair("south = 45\nwest = 7\nnorth = 46\neast = 6\n", "east is not east of west")}) {
        const auto broken = parse_scene(folder + sides, "s.toml", "data");
        ASSERT_FALSE(broken);
        EXPECT_NE(broken.error().message.find(sentence), std::string::npos)
            << broken.error().message;
    }
}

TEST(SceneFile, PointLightsHaveAPlaceAndALight) {
    const std::string terrain = "[terrain]\ngenerator = \"natural\"\n[[point_light]]\n";
    const auto scene = parse_scene(terrain + "at = [46.5, -7]\n[[point_light]]\nat = [1, 2]\n"
                                             "height = 3\nintensity = 400\nrange = 90\n"
                                             "color = \"#ffcc88\"\n",
                                   "scene.toml", "/folder");
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->point_lights.size(), 2U);
    const PointLightDescription& plain = scene->point_lights[0];
    EXPECT_EQ(plain.at, glm::dvec2(46.5, -7.0));
    EXPECT_EQ(plain.height, 5.0);
    EXPECT_EQ(range_of(plain), 50.0);
    EXPECT_EQ(plain.color, (Rgba8{255, 255, 255, 255}));
    const PointLightDescription& all = scene->point_lights[1];
    EXPECT_EQ(all.height, 3.0);
    EXPECT_EQ(all.intensity, 400.0);
    EXPECT_EQ(range_of(all), 90.0);
    EXPECT_EQ(all.color, (Rgba8{255, 204, 136, 255}));
    for (const auto& [wrong, sentence] :
         {std::pair("height = 3", "at is missing"), std::pair("at = [1, 2, 3]", "at is [1, 2, 3]"),
          std::pair("at = [1, 2]\nintensity = 0", "intensity is 0, a number above 0"),
          std::pair("at = [1, 2]\nintensity = 1e13", "intensity is 10000000000000"),
          std::pair("at = [1, 2]\nrange = -1", "range is -1"),
          std::pair("at = [1, 2]\nheight = inf", "height is inf"),
          std::pair("at = [1, 2]\ncolor = \"red\"",
                    "color is \"red\", a color such as \"#ffcc88\" was expected"),
          std::pair("at = [1, 2]\ncolor = 3", "color is 3, a text in quotes was expected"),
          std::pair("at = [1, 2]\nsize = 2", "size is unknown")}) {
        const auto refused = parse_scene(terrain + wrong, "scene.toml", "/folder");
        ASSERT_FALSE(refused) << wrong;
        EXPECT_THAT(refused.error().message, HasSubstr("[[point_light]]"));
        EXPECT_THAT(refused.error().message, HasSubstr(sentence));
    }
}

TEST(SceneFile, SurfaceShadersHaveAFileAndConstants) {
    const std::string terrain = "[terrain]\ngenerator = \"natural\"\n[surface_shader]\n";
    const auto scene = parse_scene(terrain + "file = \"snow.glsl\"\n[surface_shader.constants]\n"
                                             "line = 2500\ntint = [1, 0.5, -2]\n",
                                   "scene.toml", "/folder");
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_TRUE(scene->surface_shader);
    EXPECT_EQ(scene->surface_shader->file, "/folder/snow.glsl");
    EXPECT_EQ(scene->surface_shader->constants.at("line"), std::vector<double>{2500.0});
    EXPECT_EQ(scene->surface_shader->constants.at("tint"), (std::vector<double>{1.0, 0.5, -2.0}));
    const std::string file = "file = \"a.glsl\"\n";
    for (const auto& [wrong, sentence] :
         {std::pair(std::string(), "file is missing, a shader file was expected"),
          std::pair(file + "line = 3", "line is unknown"),
          std::pair(file + "constants = 3", "constants is 3, a table"),
          std::pair(file + "constants.a = []", "a is [], a number or a list of 1 to 4 numbers"),
          std::pair(file + "constants.a = [1, 2, 3, 4, 5]", "a is [1, 2, 3, 4, 5]"),
          std::pair(file + "constants.a = [1, \"x\"]", "a is [1, 'x']"),
          std::pair(file + "constants.a = nan", "a is nan"),
          std::pair(file + "constants.a = \"x\"", "a is 'x'")}) {
        const auto refused = parse_scene(terrain + wrong, "scene.toml", "/folder");
        ASSERT_FALSE(refused) << wrong;
        EXPECT_THAT(refused.error().message, HasSubstr(sentence));
    }
    const auto list = parse_scene("[terrain]\ngenerator = \"natural\"\n[[surface_shader]]\n" + file,
                                  "scene.toml", "/folder");
    ASSERT_FALSE(list);
    EXPECT_THAT(list.error().message, HasSubstr("surface_shader is a list [[surface_shader]], one "
                                                "table [surface_shader] was expected"));
    EXPECT_FALSE(
        parse_scene("[terrain]\ngenerator = \"natural\"\n", "a.toml", "/")->surface_shader);
}

TEST(SceneFile, LightsHaveADirection) {
    const std::string terrain = "[terrain]\ngenerator = \"natural\"\n[[light]]\n";
    const auto scene =
        parse_scene(terrain + "azimuth = 85\naltitude = 30\n[[light]]\nazimuth = -10\n"
                              "altitude = 0\nintensity = 2\ncolor = \"#88aaff\"\n",
                    "scene.toml", "/folder");
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->lights.size(), 2U);
    EXPECT_EQ(scene->lights[0].azimuth, 85.0);
    EXPECT_EQ(scene->lights[0].altitude, 30.0);
    EXPECT_EQ(scene->lights[0].intensity, 0.5);
    EXPECT_EQ(scene->lights[1].intensity, 2.0);
    EXPECT_EQ(scene->lights[1].color, (Rgba8{136, 170, 255, 255}));
    for (const auto& [wrong, sentence] :
         {std::pair("azimuth = 3", "altitude is missing, azimuth and altitude were expected"),
          std::pair("azimuth = 361\naltitude = 3", "azimuth is 361"),
          std::pair("azimuth = 1\naltitude = -3", "altitude is -3, a number"),
          std::pair("azimuth = 1\naltitude = nan", "altitude is nan"),
          std::pair("azimuth = 1\naltitude = 3\nintensity = 0", "intensity is 0, a number above 0"),
          std::pair("azimuth = 1\naltitude = 3\ncolor = \"blue\"", "color is \"blue\""),
          std::pair("azimuth = 1\naltitude = 3\nrange = 3", "range is unknown")}) {
        const auto refused = parse_scene(terrain + wrong, "scene.toml", "/folder");
        ASSERT_FALSE(refused) << wrong;
        EXPECT_THAT(refused.error().message, HasSubstr("[[light]]"));
        EXPECT_THAT(refused.error().message, HasSubstr(sentence));
    }
}

TEST(SceneFile, ObjectsHaveAFileAndAPlace) {
    const std::string terrain = "[terrain]\ngenerator = \"natural\"\n[[object]]\n";
    const auto scene = parse_scene(terrain + "file = \"a.obj\"\nat = [46.5, -7]\n"
                                             "[[object]]\nfile = \"b.glb\"\nat = [1, 2]\n"
                                             "height = 3\nheading = -90\nscale = 0.5\n",
                                   "scene.toml", "/folder");
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->objects.size(), 2U);
    EXPECT_EQ(scene->objects[0].file, "/folder/a.obj");
    EXPECT_EQ(scene->objects[0].at, glm::dvec2(46.5, -7.0));
    EXPECT_EQ(scene->objects[0].scale, 1.0);
    EXPECT_EQ(scene->objects[1].height, 3.0);
    EXPECT_EQ(scene->objects[1].heading, -90.0);
    EXPECT_EQ(scene->objects[1].scale, 0.5);
    for (const std::string wrong :
         {"at = [1, 2]", "file = \"a.obj\"", "file = \"a.obj\"\nat = [1, 2, 3]",
          "file = \"a.obj\"\nat = [1, inf]", "file = \"a.obj\"\nat = [1, 2]\nscale = 0",
          "file = \"a.obj\"\nat = [1, 2]\nheading = 361",
          "file = \"a.obj\"\nat = [1, 2]\nsize = 2"}) {
        const auto refused = parse_scene(terrain + wrong, "scene.toml", "/folder");
        ASSERT_FALSE(refused) << wrong;
        EXPECT_THAT(refused.error().message, testing::HasSubstr("[[object]]"));
    }
}

} // namespace
} // namespace reljef::io
