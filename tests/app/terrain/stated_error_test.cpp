// What pictures of terrains larger than the memory state of their errors, against the truth.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/formats/raster_writer.h"
#include "tests/app/command_line.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_pattern.h"
#include "tests/terrain/chance.h"

namespace reljef {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr int city_side = 1000; // samples

/// Blocks of 12 by 12 samples, up to 50 m high, on samples 1 m apart.
void write_city(const std::filesystem::path& path) {
    test::Chance chance(34);
    constexpr int block = 12;
    Grid<float> blocks(city_side / block + 1, city_side / block + 1);
    for (float& height : blocks.samples()) {
        height =
            chance.between(0.0, 3.0) < 2.0 ? 0.0F : static_cast<float>(chance.between(5.0, 50.0));
    }
    const io::HeightRaster raster{
        .cols = city_side, .rows = city_side, .spacing = 1.0, .first = {500000.0, 5000000.0}};
    const auto written = io::write_heights(path, raster, [&](int first, GridView<float> heights) {
        for (int row = 0; row < heights.rows(); ++row) {
            for (int col = 0; col < heights.cols(); ++col) {
                heights(col, row) = blocks(col / block, (first + row) / block);
            }
        }
    });
    ASSERT_TRUE(written) << written.error().message;
}

std::optional<double> number_after(const std::string& text, const std::string& before) {
    const auto found = test::matches(text, before + "([0-9.e+-]+)");
    return found.empty() ? std::nullopt : std::optional(std::stod(found[0][1]));
}

class StatedError : public testing::Test {
protected:
    StatedError() {
        options_.environment["XDG_CACHE_HOME"] = (folder_.path() / "cache").string();
        options_.environment["LIBGL_ALWAYS_SOFTWARE"] = "1";
    }
    [[nodiscard]] test::ProgramResult run(std::vector<std::string> arguments,
                                          const std::vector<std::string>& more = {}) const {
        arguments.insert(arguments.end(), more.begin(), more.end());
        return test::reljef(arguments, options_);
    }
    [[nodiscard]] test::ProgramResult render(const std::string& file,
                                             const std::vector<std::string>& more) const {
        return run({"render", (folder_.path() / file).string(), "--stats", "--size", size_,
                    "--samples", "1", "-o", (folder_.path() / "a.png").string()},
                   more);
    }

    std::string size_ = "160x120"; ///< of the pictures
    test::TemporaryFolder folder_;
    test::ProgramOptions options_;
};

// Rays of `exact` read the tiles that memory holds, and stated nothing. On the CPU, rays that came
// in below the ground from outside hit the walls of the next tiles. By default they draw
// the views from outside, and OpenGL the others.
TEST_F(StatedError, OfExactRaysOverAStreamIsThatOfItsTiles) {
    RELJEF_RELEASE_ONLY("reads a city");
    write_city(folder_.path() / "city.tif");
    size_ = "96x72";
    const std::vector<std::string> exact{"--technique", "exact",     "--memory",
                                         "2",           "--compare", "errors"};
    const auto unproven = render("city.tif", exact);
    EXPECT_THAT(unproven.out, HasSubstr("kept error: not proven"));
    EXPECT_THAT(unproven.err, HasSubstr("are estimates"));
    ASSERT_EQ(run({"index", (folder_.path() / "city.tif").string(), "--memory", "2"}).exit_code, 0);
    const std::vector<std::vector<std::string>> views{{},
                                                      {"--eye=0,-700,60", "--look=0,0,0"},
                                                      {"--placement", "ellipsoid"},
                                                      {"--eye=-620,-640,12", "--look=0,0,30"},
                                                      {"--projection", "orthographic"}};
    for (const std::string context : {"osmesa", "cpu"}) {
        for (std::size_t i = 0; i < views.size(); ++i) {
            if (test::cases(0, 1) == 0 && (i % 2 == 1) != (context == "cpu")) {
                continue;
            }
            std::vector<std::string> more = exact;
            more.insert(more.end(), {"--context", context});
            more.insert(more.end(), views[i].begin(), views[i].end());
            const auto drawn = render("city.tif", more);
            const auto shown = number_after(drawn.out, "at most ");
            const auto stated = number_after(drawn.out, "kept error: ");
            ASSERT_TRUE(shown && stated) << drawn.out << drawn.err;
            EXPECT_LE(*shown, *stated) << context << ' ' << testing::PrintToString(views[i]);
            EXPECT_GT(*stated, 1.0);
            EXPECT_THAT(drawn.err, HasSubstr("1 was expected of exact rays: --memory"));
            EXPECT_THAT(drawn.out, HasSubstr("unproven: 0,"));
        }
    }
}

// More tiles than the terrain has samples were said to be needed.
TEST_F(StatedError, IsKeptWithTheStatedMemoryAndNotWithATenthLess) {
    RELJEF_RELEASE_ONLY("reads a city");
    write_city(folder_.path() / "city.tif");
    const auto note_with = [&](const char* context, int megabytes) {
        const auto drawn = render("city.tif", {"--technique", "polygons:error=1", "--context",
                                               context, "--memory", std::to_string(megabytes)});
        EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
        return drawn.err.find("was the error bound") != std::string::npos ? drawn.err
                                                                          : std::string();
    };
    for (const auto& [context, megabytes] : {std::pair("cpu", 2), {"osmesa", 64}}) {
        const auto stated = number_after(note_with(context, megabytes), "bound: --memory ");
        ASSERT_TRUE(stated) << note_with(context, megabytes);
        EXPECT_EQ(note_with(context, static_cast<int>(*stated)), "");
        EXPECT_NE(note_with(context, static_cast<int>(0.9 * *stated)), "") << context;
    }
}

// The memory for the tiles was said to keep the bound, though triangles lacked, too.
TEST_F(StatedError, WhereAStreamLacksTrianglesNoMemoryIsPromised) {
    RELJEF_RELEASE_ONLY("reads a city");
    write_city(folder_.path() / "city.tif");
    const auto drawn =
        render("city.tif", {"--technique", "polygons:error=0.02", "--context", "osmesa", "--memory",
                            "2", "--placement", "plane", "--eye=0,0,30", "--look=40,30,5"});
    EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
    EXPECT_THAT(drawn.err, HasSubstr("for its tiles alone"));
    EXPECT_THAT(drawn.err, testing::Not(HasSubstr("keeps it")));
}

TEST_F(StatedError, OfAViewWithoutTerrainIsThatOfNoPixel) {
    folder_.write("a.asc", "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n"
                           "1 2 3\n4 5 6\n7 8 9\n");
    const auto drawn = render(
        "a.asc", {"--compare", "errors", "--context", "cpu", "--eye=0,0,20", "--look=0,1,40"});
    EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
    EXPECT_THAT(drawn.out, HasSubstr("no terrain in the view"));
}

// 2e8 pixels were stated, and a view too narrow for floats was blamed, beside a steep wall.
TEST_F(StatedError, BesideASteepWallHasTheReasonOfTheWall) {
    folder_.write("t.asc", "ncols 3\nnrows 2\nxllcorner 1000\nyllcorner 1000\ncellsize 10\n"
                           "0 10 3\n5 100 -20\n");
    const auto drawn =
        render("t.asc", {"--technique", "polygons:error=0.02", "--context", "osmesa", "--fov",
                         "0.05", "--exaggeration", "100", "--eye=9.7023,-1.0392,77.416",
                         "--look=0.76958,1.2349,53.494"});
    EXPECT_THAT(drawn.err, HasSubstr("pixels are off by more than the picture's size"));
    EXPECT_THAT(drawn.err, HasSubstr("more than --memory 512 is needed"));
}

// A view too narrow, more memory, or an eye too near to the ground was blamed.
TEST_F(StatedError, OfExactRaysOverASpikeHasTheReasonOfTheSpike) {
    std::string rows;
    for (int i = 0; i < 900; ++i) {
        rows += i == 450 ? "1e7 " : "5 ";
    }
    folder_.write("t.asc", "ncols 30\nnrows 30\nxllcorner 1000\nyllcorner 1000\ncellsize 10\n" +
                               rows + "\n");
    for (const char* const context : {"cpu", "osmesa"}) {
        const auto drawn =
            render("t.asc", {"--technique", "exact", "--context", context, "--placement", "plane",
                             "--eye=0,-400,60", "--look=0,0,5"});
        EXPECT_THAT(drawn.err, HasSubstr("the ground too steep, for floats")) << context;
    }
}

// It was counted when the terrain was opened, and again when its tiles were read; then the exact
// picture failed.
TEST_F(StatedError, LeavesATruncatedFileOutOnceAndComparesTheRest) {
    RELJEF_RELEASE_ONLY("waits for a file that fails");
    size_ = "96x72";
    for (const auto& [name, east] : {std::pair("west.tif", 0.0), {"east.tif", 4990.0}}) {
        std::filesystem::create_directory(folder_.path() / "tiles");
        const io::HeightRaster raster{
            .cols = 500, .rows = 500, .spacing = 10.0, .first = {300000.0 + east, 5000000.0}};
        const auto written = io::write_heights(
            folder_.path() / "tiles" / name, raster, [](int first, GridView<float> heights) {
                for (int row = 0; row < heights.rows(); ++row) {
                    for (int col = 0; col < heights.cols(); ++col) {
                        heights(col, row) =
                            static_cast<float>(100.0 * std::sin(0.1 * col + 0.07 * (first + row)));
                    }
                }
            });
        ASSERT_TRUE(written) << written.error().message;
    }
    const std::filesystem::path broken = folder_.path() / "tiles/east.tif";
    std::filesystem::resize_file(broken, std::filesystem::file_size(broken) / 2);
    for (const char* const technique : {"exact", "auto:error=1"}) {
        const auto drawn = render("tiles", {"--technique", technique, "--memory", "2", "--context",
                                            "cpu", "--compare", "errors"});
        EXPECT_THAT(drawn.out, HasSubstr("% wrong")) << drawn.err;
        EXPECT_THAT(drawn.err, HasSubstr("1 of the files asked for could not be read"));
        EXPECT_THAT(drawn.err, Not(HasSubstr("shown coarser")));
    }
}

} // namespace
} // namespace reljef
