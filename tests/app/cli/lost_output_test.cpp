#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/command_line.h"
#include "tests/support/temporary_folder.h"

namespace reljef {
namespace {

using test::expect_refusal;

constexpr const char* tiny_dem = "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 10\n"
                                 "1 9 3\n4 2 6\n7 8 1\n";

// Runs reljef behind a shell's limits and redirections: `before` and `after` its words.
test::ProgramResult in_shell(const std::string& before, const std::vector<std::string>& arguments,
                             const std::string& after = "") {
    std::vector<std::string> all{"-c", before + R"( exec "$0" "$@" )" + after, RELJEF_BINARY};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return test::run_program("/bin/sh", all);
}

// Runs reljef in a folder on a disk of 4 kB of its own, and prints the names of what it leaves
// there. Exit status 77 where this system does not let anybody have one.
test::ProgramResult on_a_full_disk(const std::vector<std::string>& arguments) {
    const test::TemporaryFolder folder;
    std::vector<std::string> all{"-rm", "/bin/sh", "-c",
                                 R"(mount -t tmpfs -o size=4k none . 2>/dev/null || exit 77
                                    cd "$PWD"; "$0" "$@"; status=$?; ls -A; exit $status)",
                                 RELJEF_BINARY};
    all.insert(all.end(), arguments.begin(), arguments.end());
    test::ProgramOptions options;
    options.folder = folder.path();
    auto result = test::run_program("/usr/bin/unshare", all, options);
    if (result.err.rfind("unshare: ", 0) == 0) {
        result.exit_code = 77;
    }
    return result;
}

class FullDiskVideo : public testing::Test {
protected:
    const test::TemporaryFolder folder_; // on a disk with room
    const std::string dem_ = folder_.write("dem.asc", tiny_dem).string();
};
class FullDisk : public FullDiskVideo, public testing::WithParamInterface<std::string> {};

TEST_P(FullDisk, IsToldAndLeavesNothing) {
    const std::string file = "picture." + GetParam();
    const auto result = on_a_full_disk({"render", dem_, "--size", "640x480", "--context", "osmesa",
                                        "--quiet", GetParam() == "exr" ? "--hit" : "-o", file});
    if (result.exit_code == 77) {
        GTEST_SKIP() << "no disk of one's own here";
    }
    expect_refusal(result, 1, {file, "cannot be written", "No space left"});
    EXPECT_EQ(result.out, "");
}

INSTANTIATE_TEST_SUITE_P(Formats, FullDisk,
                         testing::Values("png", "jpg", "gif", "tga", "webp", "bmp", "tif", "exr"),
                         [](const auto& info) { return info.param; });

// GDAL writes these, and names the file that it writes.
TEST_F(FullDiskVideo, OfALargeTiffIsToldWithItsOwnName) {
    const auto result = on_a_full_disk({"render", dem_, "--size", "16640x64", "--context", "osmesa",
                                        "--quiet", "--technique", "texture", "-o", "picture.tif"});
    if (result.exit_code == 77) {
        GTEST_SKIP() << "no disk of one's own here";
    }
    expect_refusal(result, 1, {"picture.tif: cannot be written", "picture.tif"});
    EXPECT_THAT(result.err, testing::Not(testing::HasSubstr(".reljef"))) << result.err;
    EXPECT_EQ(result.out, "");
}

TEST_F(FullDiskVideo, IsToldAndLeavesNothing) {
    const auto result =
        on_a_full_disk({"render", dem_, "--size", "64x48", "--context", "osmesa", "--quiet",
                        "--path", "orbit", "--frames", "30", "-o", "flight.mp4"});
    if (result.exit_code == 77 || result.err.find("ffmpeg was not found") != std::string::npos) {
        GTEST_SKIP() << "no disk of one's own, or no ffmpeg, here";
    }
    expect_refusal(result, 1, {"flight.mp4", "ffmpeg", "No space left"});
    EXPECT_EQ(result.out, "");
}

// A driver maps a file there, and the system ends a program whose mapped file finds no room.
TEST_F(FullDiskVideo, OfTheCacheCostsNoPicture) {
    const test::TemporaryFolder disk;
    const std::string picture = (folder_.path() / "a.png").string();
    test::ProgramOptions options;
    options.folder = disk.path();
    const auto result =
        test::run_program("/usr/bin/unshare",
                          {"-rm", "/bin/sh", "-c",
                           R"(mount -t tmpfs -o size=16k none . 2>/dev/null || exit 77
            unset MESA_SHADER_CACHE_DIR MESA_SHADER_CACHE_DISABLE
            cd "$PWD"; XDG_CACHE_HOME=$PWD exec "$0" "$@")",
                           RELJEF_BINARY, "render", dem_, "--technique", "relief", "--size",
                           "32x24", "--context", "osmesa", "-o", picture},
                          options);
    if (result.exit_code == 77 || result.err.rfind("unshare: ", 0) == 0) {
        GTEST_SKIP() << "no disk of one's own here";
    }
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(std::filesystem::exists(picture));
}

TEST(ClosedStreams, OutputThatIsLostIsAFailure) {
    expect_refusal(in_shell("", {"techniques"}, ">&-"), 1, {"standard output"});
    expect_refusal(in_shell("", {"techniques"}, ">/dev/full"), 1, {"standard output", "No space"});
    expect_refusal(in_shell("", {"--help"}, ">/dev/full"), 1, {"standard output", "No space"});
}

TEST(ClosedStreams, MessagesThatNobodyReadsEndNothing) {
    for (const char* nowhere : {"2>&-", "2>/dev/full"}) {
        EXPECT_EQ(in_shell("", {"techniques"}, nowhere).exit_code, 0) << nowhere;
        EXPECT_EQ(in_shell("", {"techniques", "--bad"}, nowhere).exit_code, 2) << nowhere;
        EXPECT_EQ(in_shell("", {"info", "/none.tif"}, nowhere).exit_code, 1) << nowhere;
    }
}

class SameFile : public testing::Test {
protected:
    void SetUp() override {
        folder_.write("dem.asc", tiny_dem);
        folder_.write("photo.png", photo_);
    }
    // In the folder, whose files must be as before.
    void expect_kept(std::vector<std::string> more, const std::vector<std::string>& parts) {
        std::vector<std::string> arguments{"render",    "dem.asc", "--size", "64x48",
                                           "--context", "osmesa",  "--quiet"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        test::ProgramOptions options;
        options.folder = folder_.path();
        const auto names = folder_.names();
        expect_refusal(test::reljef(arguments, options), 2, parts);
        EXPECT_EQ(folder_.names(), names);
        EXPECT_EQ(test::read_bytes(folder_.path() / "photo.png"), photo_);
    }

    test::TemporaryFolder folder_;
    std::string photo_ = "P6\n2 2\n255\n123456789abc"; // GDAL goes by the content
};

TEST_F(SameFile, TwoOutputsUnderOneName) {
    expect_kept({"-o", "a.png", "--contact-sheet", "./a.png"}, {"a.png", "--contact-sheet"});
    expect_kept({"-o", "a.exr", "--hit", "../" + folder_.path().filename().string() + "/a.exr"},
                {"a.exr", "--hit"});
}

TEST_F(SameFile, ALinkToTheOtherOutputThatIsNotThereYet) {
    std::filesystem::create_symlink("a.exr", folder_.path() / "b.exr");
    expect_kept({"-o", "a.exr", "--hit", "b.exr"}, {"a.exr", "--hit"});
}

TEST_F(SameFile, NumberedPictureUnderTheSheetsName) {
    expect_kept({"-o", "%d.png", "--path", "orbit", "--frames", "5", "--contact-sheet", "3.png"},
                {"3.png", "--contact-sheet"});
}

TEST_F(SameFile, OutputOverTheImagery) {
    expect_kept({"--imagery", "photo.png", "-o", "photo.png"}, {"photo.png", "--imagery"});
}

TEST_F(SameFile, OutputOverTheRampTheGeoidOrTheCalibration) {
    expect_kept({"--technique", "auto", "--calibration", "photo.png", "-o", "photo.png"},
                {"photo.png", "--calibration"});
    expect_kept({"--ramp", "photo.png", "-o", "photo.png"}, {"photo.png", "--ramp"});
    expect_kept({"--geoid", "photo.png", "-o", "./photo.png"}, {"photo.png", "--geoid"});
}

TEST_F(SameFile, OutputOverTheTerrainByAnotherName) {
    std::filesystem::create_symlink("photo.png", folder_.path() / "link.png");
    test::ProgramOptions options;
    options.folder = folder_.path();
    expect_refusal(test::reljef({"render", "photo.png", "-o", "link.png", "--size", "64x48",
                                 "--context", "osmesa", "--quiet"},
                                options),
                   2, {"link.png", "TERRAIN"});
}

TEST_F(SameFile, OutputOverATileOfAFolder) {
    const std::filesystem::path tiles = folder_.path() / "tiles";
    std::filesystem::create_directory(tiles);
    folder_.write("tiles/place.asc", "ncols 3\nnrows 3\nxllcorner 6\nyllcorner 45\ncellsize 0.01\n"
                                     "1 2 3\n4 5 6\n7 8 9\n");
    folder_.write(
        "tiles/place.prj",
        "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]],"
        "PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]]\n");
    folder_.write("tiles/0001.png", photo_);
    test::ProgramOptions options;
    options.folder = folder_.path();
    for (const std::vector<std::string>& output :
         {std::vector<std::string>{"-o", "tiles/0001.png"},
          {"-o", "./tiles/%04d.png", "--frames", "3", "--path", "orbit"}}) {
        std::vector<std::string> arguments{"render",    "tiles",  "--size", "64x48",
                                           "--context", "osmesa", "--quiet"};
        arguments.insert(arguments.end(), output.begin(), output.end());
        expect_refusal(test::reljef(arguments, options), 2, {"0001.png", "TERRAIN"});
    }
    EXPECT_EQ(test::read_bytes(tiles / "0001.png"), photo_);
}

TEST_F(SameFile, OutputOverATextureOfTheGallery) {
    std::filesystem::create_directory(folder_.path() / "tile");
    for (const char* name : {"tile/a_color.png", "tile/a_height.png"}) {
        folder_.write(name, photo_);
    }
    folder_.write("scene.toml",
                  "[terrain]\ngenerator = \"gallery\"\n[gallery]\ntextures = \"tile\"\n");
    test::ProgramOptions options;
    options.folder = folder_.path();
    for (const std::vector<std::string>& terrain :
         {std::vector<std::string>{"gallery", "--textures", "tile"}, {"scene.toml"}}) {
        std::vector<std::string> arguments{"render", "-o",     "tile/a_height.png",
                                           "--size", "64x48",  "--context",
                                           "osmesa", "--quiet"};
        arguments.insert(arguments.begin() + 1, terrain.begin(), terrain.end());
        expect_refusal(test::reljef(arguments, options), 2, {"a_height.png", "textures"});
        EXPECT_EQ(test::read_bytes(folder_.path() / "tile" / "a_height.png"), photo_);
    }
}

TEST_F(SameFile, OutputOverWhatTheSceneFileNames) {
    folder_.write("scene.toml", "[terrain]\nheights = \"photo.png\"\n");
    test::ProgramOptions options;
    options.folder = folder_.path();
    expect_refusal(test::reljef({"render", "scene.toml", "-o", "photo.png", "--size", "64x48",
                                 "--context", "osmesa", "--quiet"},
                                options),
                   2, {"photo.png", "heights"});
    EXPECT_EQ(test::read_bytes(folder_.path() / "photo.png"), photo_);
}

} // namespace
} // namespace reljef
