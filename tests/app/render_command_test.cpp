#include <cmath>

#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "tests/app/command_line.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"
#include "tests/support/test_program.h"

namespace reljef {
namespace {

// Root of the sum of the variances of the three channels: a picture of something is not of one
// colour. Land and sea may differ in hue alone.
double contrast(const Image& image) {
    glm::dvec3 sum(0.0);
    glm::dvec3 squares(0.0);
    for (const Rgba8 pixel : image.samples()) {
        const glm::dvec3 color(pixel.r, pixel.g, pixel.b);
        sum += color;
        squares += color * color;
    }
    const auto n = static_cast<double>(image.size());
    const glm::dvec3 variances = squares / n - sum * sum / (n * n);
    return std::sqrt(variances.r + variances.g + variances.b);
}

class EveryRaster : public testing::TestWithParam<const char*> {};

TEST_P(EveryRaster, gives_a_picture) {
    RELJEF_RELEASE_ONLY("each is read by a test of its own, and drawing them is the same");
    RELJEF_NEED_DATA(GetParam());
    const test::TemporaryFolder folder;
    const auto file = (folder.path() / "picture.png").string();
    const auto result = test::reljef({"render", test::data_path(GetParam()).string(), "--size",
                                      "160x120", "--context", "osmesa", "-o", file});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto image = io::read_image(file);
    ASSERT_TRUE(image) << image.error().message;
    EXPECT_GT(contrast(*image), 8.7); // 5 in each channel
    EXPECT_EQ(folder.names(), std::vector<std::string>{"picture.png"});
}

INSTANTIATE_TEST_SUITE_P(
    Data, EveryRaster,
    testing::Values(
        "natural/SainteHelens.dem", "natural/craterlake-elev-16bit-30m.tif",
        "natural/derived/mt_rainier_90m_cog.tif", "natural/derived/n45e006_513_metres.pgm",
        "natural/derived/n45e006_513_png16_0-4672m.png", "natural/derived/sthelens.hf2",
        "natural/derived/sthelens.ter", "natural/derived/sthelens_ftUS_compound_crs.tif",
        "natural/irrlicht_terrain-heightmap.bmp", "natural/luxembourg_elev.tif",
        "natural/mt_rainier_90m.tif", "natural/n00_e006_3arc_v2.dt1",
        "natural/png16_height_1024.png", "natural/sba_elev32_wgs84_512x512.tif",
        "natural/springcreek_30m.asc", "natural/srtm3/N22W160v2.3a.hgt.zip",
        "natural/srtm3/N45E006.hgt", "natural/srtm3/N49E001.hgt",
        "urban/annarbor/test_building.tif", "urban/annarbor/test_dsm.tif",
        "urban/annarbor/test_dtm.tif", "urban/delft/tud-dsm-5m.tif", "urban/delft/tud-dtm-5m.tif"));

TEST(RenderCommand, drapes_imagery) {
    RELJEF_NEED_DATA("natural/craterlake-imagery-30m.tif");
    const test::TemporaryFolder folder;
    const auto plain = (folder.path() / "plain.png").string();
    const auto draped = (folder.path() / "draped.png").string();
    const auto dem = test::data_path("natural/craterlake-elev-16bit-30m.tif").string();
    const std::vector<std::string> common{"render",  dem,         "--size",
                                          "160x120", "--context", "osmesa"};
    auto arguments = common;
    arguments.insert(arguments.end(), {"-o", plain});
    ASSERT_EQ(test::reljef(arguments).exit_code, 0);
    arguments = common;
    arguments.insert(arguments.end(),
                     {"-o", draped, "--imagery",
                      test::data_path("natural/craterlake-imagery-30m.tif").string()});
    const auto result = test::reljef(arguments);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(*io::read_image(plain), *io::read_image(draped));
}

TEST(RenderCommand, sequence_and_contact_sheet) {
    RELJEF_RELEASE_ONLY("the gallery and the flights have other tests");
    const test::TemporaryFolder folder;
    const auto result =
        test::reljef({"render", test::small_terrain(folder, "urban"), "--path", "orbit", "--frames",
                      "3", "--size", "160x120", "--context", "osmesa", "--technique", "texture",
                      "-o", (folder.path() / "f" / "%03d.png").string(), "--contact-sheet",
                      (folder.path() / "sheet.png").string()});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "f" / "002.png"));
    EXPECT_NE(*io::read_image(folder.path() / "f" / "000.png"),
              *io::read_image(folder.path() / "f" / "001.png"));
    EXPECT_TRUE(io::read_image(folder.path() / "sheet.png"));
}

TEST(RenderCommand, the_gallery_shows_its_tiles_by_any_technique) {
    RELJEF_RELEASE_ONLY("each technique has tests of its own");
    const test::TemporaryFolder folder;
    const std::string gallery = test::small_terrain(folder, "gallery");
    const auto render = [&](const char* name, std::vector<std::string> options) {
        const auto file = (folder.path() / name).string();
        std::vector<std::string> arguments{"render", gallery, "--size",    "96x72", "--quiet",
                                           "-o",     file,    "--context", "osmesa"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const auto result = test::reljef(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return io::read_image(file).value();
    };
    const Image usual = render("a.png", {});
    EXPECT_NE(render("b.png", {"--technique", "relief"}), usual); // a fence without holes
    EXPECT_NE(render("c.png", {"--technique", "emboss", "--textures", "cobble"}), usual);
}

TEST(RenderCommand, tiles_are_refused_where_there_are_none_and_where_they_are_unknown) {
    const test::TemporaryFolder folder;
    const std::string urban = test::small_terrain(folder, "urban");
    const std::string gallery = test::small_terrain(folder, "gallery");
    const auto refused = [](std::vector<std::string> arguments, const char* words) {
        arguments.insert(arguments.begin(), "render");
        arguments.insert(arguments.end(), {"-o", "never.png", "--context", "osmesa", "--quiet"});
        test::expect_refusal(test::reljef(arguments), 2, {words});
        EXPECT_FALSE(std::filesystem::exists("never.png"));
    };
    refused({urban, "--textures", "rock"}, "only the gallery shows tiles, not urban");
    refused({"gallery", "--textures", "wood"},
            "one of mixed, brick, rock, cobble, fence, rings, copper or a folder");
    refused({"urban", "--imagery", "a.png"}, "--imagery: a.png found, but urban brings its own");
    refused({"gallery", "--max-error", "1"}, "--max-error: gallery found, a terrain was expected");
    refused({"urban", "--area", "1,2,3,4"}, "--area found, but it is no folder of tiles");
    refused({urban, "--technique", "emboss"}, "a mesh with a detail texture was expected");
    refused({urban, "--technique", "lattice"}, "exact shapes a terrain by its heights");
    refused({gallery, "--textures", "brick", "--technique", "prewarp"},
            "a mesh that is not flat found");
}

TEST(RenderCommand, a_tile_of_detail_is_refused_where_it_is_unknown_or_nothing_shows_it) {
    const test::TemporaryFolder folder;
    const std::string dem =
        folder
            .write("dem.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n1 2\n3 4\n")
            .string();
    const auto refused = [&](int exit_code, std::vector<std::string> options,
                             const std::string& words) {
        std::vector<std::string> arguments{"render", dem,         "-o",     "never.png", "--size",
                                           "64x48",  "--context", "osmesa", "--quiet"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        test::expect_refusal(test::reljef(arguments), exit_code, {words});
        EXPECT_FALSE(std::filesystem::exists("never.png"));
    };
    refused(2, {"--detail", "nope"}, "--detail: texture set 'nope' found, one of brick, rock");
    refused(2, {"--detail", "nowhere/tiles"}, "'nowhere/tiles' found, one of brick, rock");
    refused(1, {"--detail", folder.path().string()}, folder.path().string());
    for (const std::string width : {"0", "-3", "nan", "inf", "1e7", "", "wide"}) {
        refused(2, {"--detail", "rock:width=" + width}, "--detail: width");
    }
    refused(2, {"--detail", "rock:scale=0"}, "--detail: scale");
    refused(2, {"--detail", "rock:wide=3"}, "width=METRES or scale=S was expected");
    refused(2, {"--detail", ":width=3"}, "the name or folder of a detail texture, then");
    refused(2, {"--detail", "rock:"}, "the name or folder of a detail texture, then");
    refused(2, {"--detail", "rock:width=3,width=4"}, "width found twice");
    refused(2, {"--detail", "rock", "--technique", "exact"}, "polygons was expected");
    refused(2, {"--detail", "rock", "--detail-technique", "lattice"}, "normal, relief and exact");
    refused(2, {"--detail", "rock", "--detail-technique", "relief:depth=write"},
            "none beside steps and shadow");
    refused(2, {"--detail-technique", "relief"}, "without --detail");
    refused(2, {"--technique", "displacement"}, "a mesh with a detail texture was expected");
}

// Of the metres that they are drawn as.
TEST(RenderCommand, HeightsOfEightBitsAreToldWithTheirStepsOnce) {
    const test::TemporaryFolder folder;
    const auto dem = folder.write(
        "dem.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n1 2\n3 4\n");
    const auto tiles = folder.path() / "tiles";
    std::filesystem::create_directory(tiles);
    for (const char* name : {"color.png", "height.png"}) {
        ASSERT_TRUE(io::write_image(tiles / name, Image(8, 8, Rgba8{90, 90, 90, 255})));
    }
    const auto result = test::reljef({"render", dem.string(), "--size", "64x48", "--context",
                                      "osmesa", "-o", (folder.path() / "a.png").string(),
                                      "--detail", tiles.string() + ":width=40,scale=0.1"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::string note = "tiles: heights of 8 bits; over a range of 4 m they come in steps of "
                             "0.016 m\n";
    const auto found = result.err.find(note);
    ASSERT_NE(found, std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("8 bits", found + note.size()), std::string::npos);
}

TEST(RenderCommand, TheTruthOfTheGalleryIsMisuse) {
    test::expect_refusal(test::reljef({"render", "gallery", "--truth", "-o", "never.png"}), 2,
                         {"--truth: gallery found", "--technique exact"});
}

// Told apart by what is wrong first: the gallery's technique is chosen before its textures.
TEST(RenderCommand, mixed_is_each_models_own_technique_and_a_terrains_none) {
    const test::TemporaryFolder folder;
    const auto refused = [&](int exit_code, const char* keys,
                             const std::vector<std::string>& arguments, const char* words) {
        const auto scene =
            folder.write("s.toml", std::string("[terrain]\nsize = 33\n") + keys).string();
        std::vector<std::string> all{"render", scene,     "--context", "osmesa", "--size",
                                     "64x48",  "--quiet", "-o",        "a.png"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        test::expect_refusal(test::reljef(all), exit_code, {words});
    };
    const char* const gallery =
        "generator = \"gallery\"\n[gallery]\ntechnique = \"magic\"\ntextures = \"wood\"\n";
    refused(1, gallery, {}, "technique 'magic' found");
    refused(1, gallery, {"--technique", "mixed"}, "texture set 'wood' found");
    refused(2, "generator = \"natural\"\n", {"--technique", "mixed"}, "--technique: mixed found");
}

// A folder of that name where the program runs is another one.
TEST(RenderCommand, textures_of_a_scene_file_are_beside_it_and_its_faults_name_it) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directories(folder.path() / "wall");
    std::filesystem::create_directories(folder.path() / "scenes");
    test::ProgramOptions options;
    options.folder = folder.path();
    const auto refused = [&](const char* keys, const char* words) {
        folder.write("scenes/halls.toml",
                     std::string("[terrain]\ngenerator = \"gallery\"\nsize = 33\n[gallery]\n") +
                         keys);
        const auto result = test::reljef({"render", "scenes/halls.toml", "--context", "osmesa",
                                          "--size", "64x48", "--quiet", "-o", "a.png"},
                                         options);
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
    };
    refused("textures = \"wall\"\n", "scenes/halls.toml: texture set 'wall' found");
    refused("technique = \"magic\"\n", "scenes/halls.toml: [gallery] technique 'magic' found");
}

TEST(RenderCommand, a_camera_below_the_ground_is_lifted_and_a_fault_of_a_scene_file) {
    const test::TemporaryFolder folder;
    const std::string text = "[terrain]\ngenerator = \"natural\"\nsize = 65\n";
    const std::string scene =
        folder.write("under.toml", text + "[camera]\neye = [0, 0, -500]\nlook = [100, 0, -500]\n")
            .string();
    const auto run = [&](std::vector<std::string> more) {
        more.insert(more.begin(), "render");
        more.insert(more.end(), {"--size", "64x48", "--context", "osmesa"});
        return test::reljef(more);
    };
    const auto file = (folder.path() / "file.png").string();
    const auto option = (folder.path() / "option.png").string();
    test::expect_refusal(run({scene, "-o", file}), 1,
                         {"under.toml", "below the ground: lifted to"});
    const auto optional = run({folder.write("plain.toml", text).string(), "--eye", "0,0,-500",
                               "--look", "100,0,-500", "-o", option});
    EXPECT_EQ(optional.exit_code, 0) << optional.err;
    EXPECT_NE(optional.err.find("--eye: "), std::string::npos) << optional.err;
    EXPECT_EQ(test::read_bytes(file), test::read_bytes(option));
    const auto allowed = run({scene, "-o", option, "--allow-underground"});
    EXPECT_EQ(allowed.exit_code, 0) << allowed.err;
    EXPECT_NE(test::read_bytes(file), test::read_bytes(option));
}

TEST(RenderCommand, standard_output_takes_the_picture_alone) {
    const test::TemporaryFolder folder;
    const auto file = (folder.path() / "a.png").string();
    const std::string natural = test::small_terrain(folder, "natural");
    const std::vector<std::string> common{"render",    natural,  "--size",  "64x48",
                                          "--context", "osmesa", "--quiet", "-o"};
    auto arguments = common;
    arguments.push_back(file);
    ASSERT_EQ(test::reljef(arguments).exit_code, 0);
    arguments = common;
    arguments.emplace_back("-");
    const auto result = test::reljef(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out, test::read_bytes(file));
    arguments.emplace_back("--stats");
    test::expect_refusal(test::reljef(arguments), 2, {"-o: - found beside --stats"});
    arguments = common;
    arguments.insert(arguments.end(), {"-", "--path", "orbit", "--frames", "2"});
    test::expect_refusal(test::reljef(arguments), 2, {"-o: '-' found"});
}

TEST(RenderCommand, hits_do_not_appear_beside_a_picture_that_cannot_be_written) {
    const test::TemporaryFolder folder;
    const test::TemporaryFolder scenes;
    const auto hits = (folder.path() / "hits.exr").string();
    const auto result = test::run_program(
        "/bin/sh",
        {"-c", "'" RELJEF_BINARY "' render '" + test::small_terrain(scenes, "natural") +
                   "' --size 160x120 --context osmesa --quiet --hit '" + hits +
                   "' -o - > /dev/full"},
        {});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find("standard output: cannot be written"), std::string::npos)
        << result.err;
    EXPECT_TRUE(folder.names().empty());
}

// The picture fits the file size that is allowed, the hits do not.
TEST(RenderCommand, a_picture_does_not_appear_beside_hits_that_cannot_be_written) {
    const test::TemporaryFolder folder;
    const test::TemporaryFolder scenes;
    const std::string path = folder.path().string();
    const auto result =
        test::run_program("/bin/sh",
                          {"-c", "trap '' XFSZ; ulimit -f 200; '" RELJEF_BINARY "' render '" +
                                     test::small_terrain(scenes, "natural") +
                                     "' --size 320x240 --context osmesa --quiet --hit '" + path +
                                     "/hits.exr' -o '" + path + "/a.jpg'"},
                          {});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find("hits.exr: cannot be written: File too large"), std::string::npos)
        << result.err;
    EXPECT_TRUE(folder.names().empty());
}

TEST(RenderCommand, same_command_same_bits) {
    RELJEF_RELEASE_ONLY("the same command has other tests");
    const test::TemporaryFolder folder;
    const std::string natural = test::small_terrain(folder, "natural");
    for (const char* name : {"a.png", "b.png"}) {
        ASSERT_EQ(test::reljef({"render", natural, "--size", "200x150", "--context", "osmesa", "-o",
                                (folder.path() / name).string()})
                      .exit_code,
                  0);
    }
    EXPECT_EQ(*io::read_image(folder.path() / "a.png"), *io::read_image(folder.path() / "b.png"));
}

TEST(RenderCommand, triangles_have_four_samples_a_pixel_and_rays_one) {
    RELJEF_RELEASE_ONLY("the driver has tests of its own");
    const test::TemporaryFolder folder;
    const auto file = (folder.path() / "a.png").string();
    const auto scene = test::small_terrain(folder, "natural");
    const auto drawn = [&](const std::string& technique, const std::vector<std::string>& more) {
        std::vector<std::string> arguments{
            "render",  scene,     "--technique", technique, "--base", "plane", "--size",
            "160x120", "--quiet", "--context",   "osmesa",  "-o",     file};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const auto result = test::reljef(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return io::read_image(file).value();
    };
    const Image one = drawn("polygons", {"--samples", "1"});
    EXPECT_NE(drawn("polygons", {}), one);
    EXPECT_EQ(drawn("polygons", {}), drawn("polygons", {"--samples", "4"}));
    EXPECT_EQ(drawn("exact", {}), drawn("exact", {"--samples", "1"}));
    EXPECT_NE(drawn("exact", {"--samples", "2"}), drawn("exact", {}));
}

TEST(RenderCommand, works_from_any_folder) {
    RELJEF_RELEASE_ONLY("the same command has other tests");
    const test::TemporaryFolder folder;
    test::ProgramOptions options;
    options.folder = folder.path();
    const auto result = test::reljef({"render", "natural", "--size", "80x60", "--context", "osmesa",
                                      "--technique", "texture", "-o", "here.png"},
                                     options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(folder.names(), std::vector<std::string>{"here.png"});
}

} // namespace
} // namespace reljef
