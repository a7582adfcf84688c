#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/atomic_file.h"
#include "engine/io/image/channels.h"
#include "engine/io/image/image.h"
#include "engine/io/image/texture_files.h"
#include "tests/app/command_line.h"
#include "tests/support/process_state.h"
#include "tests/support/temporary_folder.h"

namespace reljef {
namespace {

using test::expect_refusal;

// Smooth, and it fits together at its borders.
float wave(int col, int row) {
    const double step = 2.0 * std::acos(-1.0) / 32.0;
    return static_cast<float>(0.5 + 0.3 * std::sin(step * col) + 0.2 * std::cos(step * row));
}

class MapsCommand : public testing::Test {
protected:
    void SetUp() override {
        io::Channels heights = io::make_channels(32, 32, 1);
        for (int row = 0; row < 32; ++row) {
            for (int col = 0; col < 32; ++col) {
                heights.at(col, row, 0) = wave(col, row);
            }
        }
        write(file("height.png"), heights);
    }
    static void write(const std::string& path, const io::Channels& channels) {
        const auto bytes = io::encode_channels(path, channels);
        ASSERT_TRUE(bytes) << bytes.error().message;
        ASSERT_TRUE(write_file(path, *bytes));
    }
    [[nodiscard]] std::string file(const std::string& name) const {
        return (folder_.path() / name).string();
    }
    static io::Channels read(const std::string& path) { return io::read_channels(path).value(); }
    // Whatever is asked for must not appear.
    void refused(std::vector<std::string> arguments, int code,
                 const std::vector<std::string>& parts) {
        const auto before = folder_.names();
        arguments.insert(arguments.begin(), "maps");
        expect_refusal(test::reljef(arguments), code, parts);
        EXPECT_EQ(folder_.names(), before);
    }

    test::TemporaryFolder folder_;
};

TEST_F(MapsCommand, NormalsLeadBackToTheHeights) {
    const auto made = test::reljef({"maps", file("height.png"), "--normals", file("n.png"),
                                    "--combined", file("both.exr"), "--scale", "0.2"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_EQ(read(file("n.png")).count, 3);
    const io::Channels both = read(file("both.exr"));
    ASSERT_EQ(both.count, 4);
    EXPECT_NEAR(both.at(9, 4, 3), wave(9, 4), 1e-4);
    const auto back = test::reljef({"maps", file("n.png"), "--from", "normals", "--scale", "0.2",
                                    "--heights", file("again.exr")});
    ASSERT_EQ(back.exit_code, 0) << back.err;
    const io::Channels again = read(file("again.exr"));
    for (int row = 0; row < 32; ++row) {
        for (int col = 0; col < 32; ++col) {
            ASSERT_NEAR(again.at(col, row, 0), wave(col, row), 0.01) << col << ' ' << row;
        }
    }
}

TEST_F(MapsCommand, ATextureSetIsMadeOfAPictureAndReadAgain) {
    io::Channels front = read(file("height.png"));
    write(file("back.png"), front);
    const auto made =
        test::reljef({"maps", file("height.png"), "--back", file("back.png"), "--layers",
                      file("layers.png"), "--normals", file("normal.png"), "--scale", "0.05"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    ASSERT_TRUE(io::write_image(file("color.png"), Image(32, 32, Rgba8{90, 80, 70, 255})));
    const auto files = io::find_texture_files(folder_.path());
    ASSERT_TRUE(files) << files.error().message;
    const auto set = io::read_texture_set(*files);
    ASSERT_TRUE(set) << set.error().message;
    ASSERT_TRUE(set->layers);
    EXPECT_NEAR(set->layers->heights()(3, 8).x, 0.5F + 0.5F * wave(3, 8), 1e-4);
    EXPECT_NEAR(set->layers->heights()(3, 8).y, 0.5F - 0.5F * wave(3, 8), 1e-4);
}

TEST_F(MapsCommand, ConesInFloatsAndWholeNumbersAreTheSameAndTheRelaxedOnesWider) {
    const auto made = test::reljef({"maps", file("height.png"), "--cones", file("cones.exr"),
                                    "--relaxed-cones", file("relaxed.exr"), "--quiet"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const auto coded =
        test::reljef({"maps", file("height.png"), "--cones", file("cones.png"), "--quiet"});
    ASSERT_EQ(coded.exit_code, 0) << coded.err;
    const io::Channels cones = read(file("cones.exr"));
    const io::Channels relaxed = read(file("relaxed.exr"));
    const io::Channels codes = read(file("cones.png"));
    for (int row = 0; row < 32; ++row) {
        for (int col = 0; col < 32; ++col) {
            const float share = codes.at(col, row, 0);
            ASSERT_NEAR(1024.0F * share * share, cones.at(col, row, 0), 0.05F);
            ASSERT_LE(cones.at(col, row, 0), relaxed.at(col, row, 0) + 1e-5F);
        }
    }
}

// What lies between texels is interpolated: the surface within a cell is under none of its corners'
// cones.
TEST_F(MapsCommand, ConesStandOverEachTexelAndNoneReachesIntoTheNextOnesSurface) {
    for (const std::string border : {"wrap", "clamp"}) {
        const auto made = test::reljef({"maps", file("height.png"), "--cones", file("cones.exr"),
                                        "--border", border, "--quiet"});
        ASSERT_EQ(made.exit_code, 0) << made.err;
        const io::Channels cones = read(file("cones.exr"));
        ASSERT_EQ(cones.cols, 32);
        ASSERT_EQ(cones.rows, 32);
        for (int row = 0; row < 32; ++row) {
            for (int col = 0; col + 1 < 32; ++col) {
                const float rise = wave(col + 1, row) - wave(col, row);
                if (rise > 0.01F) { // the next texel's top is beside the cone
                    ASSERT_LE(cones.at(col, row, 0), 1.02F / rise) << col << ' ' << row;
                }
            }
        }
    }
}

TEST_F(MapsCommand, HeightsAreGuessedFromAPicture) {
    Image picture(64, 64, Rgba8{40, 40, 40, 255});
    for (int row = 24; row < 40; ++row) {
        for (int col = 24; col < 40; ++col) {
            picture(col, row) = {200, 200, 200, 255};
        }
    }
    ASSERT_TRUE(io::write_image(file("wall.png"), picture));
    for (const auto& [flag, sign] : {std::pair{"--quiet", 1.0F}, {"--dark-is-high", -1.0F}}) {
        const auto made = test::reljef(
            {"maps", file("wall.png"), "--from", "colors", "--heights", file("h.png"), flag});
        ASSERT_EQ(made.exit_code, 0) << made.err;
        const io::Channels heights = read(file("h.png"));
        EXPECT_GT(sign * (heights.at(32, 32, 0) - heights.at(4, 4, 0)), 0.2F) << flag;
    }
}

TEST_F(MapsCommand, BadInputIsOneSentenceAndLeavesNothing) {
    refused({file("height.png")}, 2, {"no output found", "--normals"});
    refused({}, 2, {"PICTURE"});
    refused({file("none.png"), "--normals", file("n.png")}, 1, {"none.png", "does not exist"});
    refused({file("height.png"), "--normals", file("n.jpg")}, 2,
            {"--normals: ", "n.jpg", "cannot be written", ".png, .tif or .exr"});
    refused({file("height.png"), "--normals", file("no/n.png")}, 1, {"no/n.png"});
    refused({file("height.png"), "--normals", file("height.png")}, 2,
            {"--normals", "read as PICTURE"});
    refused({file("height.png"), "--normals", file("a.png"), "--cones", file("a.png")}, 2,
            {"--cones", "--normals writes too"});
    refused({file("height.png"), "--from", "depths", "--normals", file("n.png")}, 2,
            {"--from: 'depths' found", "heights, normals, colors"});
    refused({file("height.png"), "--scale", "0", "--normals", file("n.png")}, 2,
            {"--scale: '0' found"});
    refused({file("height.png"), "--from", "normals", "--heights", file("h.png")}, 1,
            {"1 channels found", "3 were expected"});
    io::Channels small = io::make_channels(8, 4, 1);
    write(file("back.png"), small);
    refused({file("height.png"), "--back", file("back.png"), "--layers", file("l.png"), "--normals",
             file("n.png")},
            1, {"--back: ", "back.png: 8 x 4 texels found, 32 x 32", "one size", "height.png"});
    small.at(5, 2, 0) = 1.5F;
    write(file("high.exr"), small);
    refused({file("high.exr"), "--normals", file("n.png")}, 1,
            {"high.exr", "a height of 1.5", "column 5, row 2"});
    folder_.write("empty.png", "");
    folder_.write("text.png", "no picture at all");
    small.at(5, 2, 0) = std::nanf("");
    write(file("nan.exr"), small);
    refused({file("nan.exr"), "--from", "colors", "--heights", file("h.png")}, 1,
            {"nan.exr: a colour of nan", "column 5, row 2"});
    refused({file("empty.png"), "--normals", file("n.png")}, 1, {"empty.png"});
    refused({file("text.png"), "--from", "colors", "--heights", file("h.png")}, 1, {"text.png"});
}

TEST_F(MapsCommand, OptionsWithoutAUseAreMisuse) {
    const std::string out = file("out.png");
    const std::string in = file("height.png");
    refused({in, "--normals", out, "--back", in}, 2, {"--back", "--layers was expected"});
    refused({in, "--normals", out, "--octaves", "3"}, 2, {"--octaves", "--from colors"});
    refused({in, "--normals", out, "--dark-is-high"}, 2, {"--dark-is-high", "--from colors"});
    refused({in, "--cones", out, "--sobel"}, 2, {"--sobel", "--normals or --combined"});
    refused({in, "--cones", out, "--green", "up"}, 2, {"--green", "normals"});
    refused({in, "--cones", out, "--scale", "0.1"}, 2, {"--scale", "normals"});
    refused({in, "--layers", out, "--border", "clamp"}, 2, {"--border", "normals, cones"});
}

// A wave across the border: mirrored there, its blur would be another one.
TEST_F(MapsCommand, HeightsGuessedFromATileFitTogetherWhereItWraps) {
    const auto made = [&](const std::vector<int>& shift, const char* border) {
        Image picture(32, 32);
        for (int row = 0; row < 32; ++row) {
            for (int col = 0; col < 32; ++col) {
                const auto value =
                    static_cast<std::uint8_t>(255.0F * wave((col + shift[0]) % 32, row));
                picture(col, row) = {value, value, value, 255};
            }
        }
        EXPECT_TRUE(io::write_image(file("tile.png"), picture));
        const auto run = test::reljef({"maps", file("tile.png"), "--from", "colors", "--border",
                                       border, "--heights", file("h.exr")});
        EXPECT_EQ(run.exit_code, 0) << run.err;
        return read(file("h.exr"));
    };
    const io::Channels here = made({0}, "wrap");
    const io::Channels shifted = made({5}, "wrap");
    const io::Channels clamped = made({5}, "clamp");
    double off = 0.0;
    for (int row = 0; row < 32; ++row) {
        for (int col = 0; col < 32; ++col) {
            ASSERT_NEAR(shifted.at(col, row, 0), here.at((col + 5) % 32, row, 0), 1e-4);
            off = std::max(off, std::abs(static_cast<double>(clamped.at(col, row, 0)) -
                                         here.at((col + 5) % 32, row, 0)));
        }
    }
    EXPECT_GT(off, 0.02);
}

TEST_F(MapsCommand, NormalsOfEitherConventionAreReadAndWritten) {
    for (const std::string green : {"down", "up"}) {
        const auto made = test::reljef({"maps", file("height.png"), "--normals", file("n.png"),
                                        "--green", green, "--scale", "0.2"});
        ASSERT_EQ(made.exit_code, 0) << made.err;
        const io::Channels normals = read(file("n.png"));
        // North of the crest the surface falls to the north: against the rows.
        EXPECT_EQ(normals.at(3, 29, 1) < 0.45F, green == "down") << green;
        const auto back = test::reljef({"maps", file("n.png"), "--from", "normals", "--green",
                                        green, "--scale", "0.2", "--heights", file("h.exr")});
        ASSERT_EQ(back.exit_code, 0) << back.err;
        EXPECT_NEAR(read(file("h.exr")).at(3, 29, 0), wave(3, 29), 0.01);
    }
}

TEST_F(MapsCommand, WhatAPersonShouldKnowOfItsInputIsANoteOnce) {
    Image ramp(32, 32);
    for (int row = 0; row < 32; ++row) {
        for (int col = 0; col < 32; ++col) {
            const auto value = static_cast<std::uint8_t>(8 * col);
            ramp(col, row) = {value, value, value, 255};
        }
    }
    ASSERT_TRUE(io::write_image(file("ramp.png"), ramp));
    const auto made =
        test::reljef({"maps", file("ramp.png"), "--normals", file("n.png"), "--scale", "0.255"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_THAT(made.err, testing::HasSubstr("ramp.png: heights of 8 bits"));
    EXPECT_THAT(made.err, testing::HasSubstr("in steps of 0.001 m"));
    EXPECT_THAT(made.err, testing::HasSubstr("do not fit together"));
    EXPECT_EQ(std::count(made.err.begin(), made.err.end(), '\n'), 2); // it is grey
    ASSERT_TRUE(io::write_image(file("red.png"), Image(8, 8, Rgba8{200, 0, 0, 255})));
    const auto red = test::reljef({"maps", file("red.png"), "--normals", file("n.png")});
    EXPECT_THAT(red.err, testing::HasSubstr("red.png: colours found, of which the first channel"));
    io::Channels normals = io::make_channels(8, 8, 3);
    std::fill(normals.values.begin(), normals.values.end(), 1.0F);
    for (int i = 0; i < 3; ++i) {
        normals.at(5, 2, i) = 0.5F; // zero
        normals.at(6, 2, i) = std::numeric_limits<float>::infinity();
    }
    write(file("bad.exr"), normals);
    const auto flat =
        test::reljef({"maps", file("bad.exr"), "--from", "normals", "--heights", file("h.png")});
    ASSERT_EQ(flat.exit_code, 0) << flat.err;
    EXPECT_THAT(flat.err, testing::HasSubstr("2 of 64 normals are zero"));
    EXPECT_THAT(flat.err, testing::HasSubstr("column 5, row 2"));
}

TEST_F(MapsCommand, CtrlCLeavesNothing) {
    io::Channels large = io::make_channels(1024, 1024, 1);
    for (std::size_t i = 0; i < large.values.size(); ++i) {
        large.values[i] = static_cast<float>((i * 2654435761U) % 1009U) / 1009.0F;
    }
    write(file("large.png"), large);
    const auto before = folder_.names();
    test::ProgramOptions options;
    options.interruption = {SIGINT, [](int process) { // the cones take far longer
                                return test::processor_seconds(process) > 1.0;
                            }};
    const auto result = test::run_program(RELJEF_BINARY,
                                          {"maps", file("large.png"), "--quiet", "--normals",
                                           file("n.png"), "--relaxed-cones", file("cones.png")},
                                          options);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.err, "reljef: interrupted\n");
    EXPECT_EQ(folder_.names(), before);
}

// A house of 8 m on a place of the Earth, with a void.
std::string house_raster(const test::TemporaryFolder& folder) {
    const std::string path = (folder.path() / "house.asc").string();
    std::ofstream out(path);
    out << "ncols 40\nnrows 40\nxllcorner 350000\nyllcorner 5100000\ncellsize 1\n"
           "NODATA_value -9999\n";
    for (int row = 0; row < 40; ++row) {
        for (int col = 0; col < 40; ++col) {
            const bool is_roof = 4 * col + row > 90 && 4 * col + row < 150;
            out << (col == 2 && row == 2 ? -9999 : is_roof ? 8 : 0) << ' ';
        }
        out << '\n';
    }
    std::ofstream(folder.path() / "house.prj")
        << "PROJCS[\"UTM 32N\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,"
           "298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],"
           "PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\",0],PARAMETER["
           "\"central_meridian\",9],PARAMETER[\"scale_factor\",0.9996],PARAMETER[\"false_easting\","
           "500000],PARAMETER[\"false_northing\",0],UNIT[\"metre\",1]]";
    return path;
}

TEST_F(MapsCommand, StraightWallsKeepPlaceVoidsAndRange) {
    const std::string house = house_raster(folder_);
    const auto made = test::reljef({"maps", house, "--straight-walls", file("straight.TIF")});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_THAT(made.err, testing::HasSubstr("samples changed, all at walls"));
    const auto before = test::reljef({"info", house});
    const auto after = test::reljef({"info", file("straight.TIF")});
    ASSERT_EQ(after.exit_code, 0) << after.err;
    for (const char* const line : {"latitude", "heights", "voids", "spacing"}) {
        const auto of = [&](const std::string& text) {
            const auto at = text.find(line);
            return at == std::string::npos ? std::string("no ") + line
                                           : text.substr(at, text.find('\n', at) - at);
        };
        EXPECT_EQ(of(after.out), of(before.out));
    }
    EXPECT_THAT(after.out, testing::HasSubstr("voids    1"));
}

TEST_F(MapsCommand, StraightWallsRefuseInOneSentence) {
    const std::string house = house_raster(folder_);
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"maps", house, "--quiet"});
        return test::reljef(more);
    };
    expect_refusal(with({"--straight-walls", file("s.png")}), 2, {"--straight-walls", ".tif"});
    expect_refusal(with({"--straight-walls", file("s.tif"), "--normals", file("n.png")}), 2,
                   {"--straight-walls", "--normals"});
    expect_refusal(with({"--wall-height", "3", "--normals", file("n.png")}), 2,
                   {"--wall-height", "--straight-walls"});
    expect_refusal(with({"--straight-walls", file("s.tif"), "--wall-height", "0"}), 2,
                   {"--wall-height", "0"});
    expect_refusal(with({"--straight-walls", file("s.tif"), "--from", "colors"}), 2, {"--from"});
    expect_refusal(with({"--straight-walls", "/nonexistent/s.tif"}), 1, {"/nonexistent"});
    expect_refusal(test::reljef({"maps", file("none.tif"), "--straight-walls", file("s.tif")}), 1,
                   {"none.tif"});
    EXPECT_FALSE(std::filesystem::exists(file("s.tif")));
}

TEST_F(MapsCommand, StraightWallsDoNotReplaceWhatASceneFileNames) {
    const std::string house = house_raster(folder_);
    ASSERT_EQ(
        test::reljef({"maps", house, "--straight-walls", file("source.tif"), "--quiet"}).exit_code,
        0);
    std::ofstream(file("scene.toml")) << "[terrain]\nheights = \"source.tif\"\n";
    const auto size = std::filesystem::file_size(file("source.tif"));
    expect_refusal(
        test::reljef({"maps", file("scene.toml"), "--straight-walls", file("source.tif")}), 2,
        {"source.tif", "heights"});
    EXPECT_EQ(std::filesystem::file_size(file("source.tif")), size);
}

} // namespace
} // namespace reljef
