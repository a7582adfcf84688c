// A DEM of the whole Earth in the program: no hole at the antimeridian and the poles.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/io/image/image.h"
#include "tests/app/command_line.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"

namespace reljef {
namespace {

class GlobeFile : public testing::Test {
protected:
    GlobeFile() {
        options_.environment["XDG_CACHE_HOME"] = (folder_.path() / "cache").string();
        options_.environment["LIBGL_ALWAYS_SOFTWARE"] = "1";
        write(180, 90);
    }
    void write(int cols, int rows) const {
        const double step = 360.0 / cols;
        std::string text = "ncols " + std::to_string(cols) + "\nnrows " + std::to_string(rows) +
                           "\nxllcorner -180\nyllcorner -90\ncellsize " + std::to_string(step) +
                           "\n";
        for (int row = 0; row < rows; ++row) {
            for (int col = 0; col < cols; ++col) {
                const double x = (col + 0.5) * step * std::numbers::pi / 180.0;
                const double y = (row + 0.5) * step * std::numbers::pi / 180.0;
                text += std::to_string(std::lround(900.0 + 500.0 * std::cos(3.0 * x + 1.0) *
                                                               std::sin(5.0 * y))) +
                        ".5 ";
            }
            text += "\n";
        }
        folder_.write("globe.asc", text);
        folder_.write("globe.prj", "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\","
                                   "6378137,298.257223563]],PRIMEM[\"Greenwich\",0],"
                                   "UNIT[\"degree\",0.0174532925199433]]");
    }
    [[nodiscard]] std::string path() const { return (folder_.path() / "globe.asc").string(); }

    /// What a view straight down shows.
    [[nodiscard]] HitBuffer hits_of(const std::string& camera,
                                    std::vector<std::string> more) const {
        const std::string file = (folder_.path() / "hit.exr").string();
        std::vector<std::string> arguments{"render", path(),    "--camera", camera, "--size",
                                           "96x72",  "--quiet", "--hit",    file};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const auto result = test::reljef(arguments, options_);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        auto hits = io::read_hits(file);
        EXPECT_TRUE(hits);
        return hits ? std::move(*hits) : HitBuffer();
    }
    /// Pixels of it that show sky.
    [[nodiscard]] int holes(const std::string& camera, std::vector<std::string> more) const {
        const HitBuffer hits = hits_of(camera, std::move(more));
        EXPECT_FALSE(hits.empty());
        return static_cast<int>(std::count_if(hits.samples().begin(), hits.samples().end(),
                                              [](const Hit& hit) { return hit.is_sky(); }));
    }

    test::TemporaryFolder folder_;
    test::ProgramOptions options_;
};

constexpr std::array cameras{"0,180,100000,0,-90", "90,0,200000,0,-90", "-90,0,200000,0,-90"};

TEST_F(GlobeFile, has_no_hole_where_it_is_read_whole) {
    for (const char* camera : cameras) {
        EXPECT_EQ(holes(camera, {}), 0) << camera;
    }
}

TEST_F(GlobeFile, has_no_hole_where_triangles_are_few) {
    RELJEF_RELEASE_ONLY("the triangles of three views");
    for (const char* camera : cameras) {
        EXPECT_EQ(holes(camera, {"--technique", "polygons:error=1"}), 0) << camera;
    }
}

TEST_F(GlobeFile, has_no_hole_where_it_is_streamed) {
    write(720, 360); // more than a megabyte holds
    for (const char* camera : cameras) {
        EXPECT_EQ(holes(camera, {"--memory", "1"}), 0) << camera;
    }
}

// Its colours and light are those of the place, where tiles of both sides meet, too.
TEST_F(GlobeFile, streamed_colours_run_on_across_the_antimeridian) {
    write(720, 360);
    const std::string file = (folder_.path() / "a.png").string();
    const auto result = test::reljef({"render", path(), "--camera", "0,180,1000000,0,-90", "--size",
                                      "96x72", "--quiet", "--stats", "--memory", "1", "-o", file},
                                     options_);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, testing::HasSubstr("streamed:"));
    const auto picture = io::read_image(file);
    ASSERT_TRUE(picture);
    for (int row = 0; row < picture->rows(); ++row) {
        for (int col = 1; col < picture->cols(); ++col) {
            ASSERT_NEAR((*picture)(col, row).g, (*picture)(col - 1, row).g, 12.0) << col;
        }
    }
}

TEST_F(GlobeFile, has_no_hole_in_the_exact_picture) {
    for (const char* camera : cameras) {
        EXPECT_EQ(holes(camera, {"--truth"}), 0) << camera;
    }
}

// The row of a latitude in the file, whose first row is half a step from the pole.
TEST_F(GlobeFile, rows_of_hits_are_those_of_the_file) {
    for (const std::vector<std::string>& way :
         {std::vector<std::string>{}, {"--truth"}, {"--memory", "1"}}) {
        for (const double latitude : {40.0, -60.0, 89.5, -89.5}) {
            const HitBuffer hits = hits_of(fmt::format("{},20,5000,0,-90", latitude), way);
            ASSERT_FALSE(hits.empty());
            const Hit& middle = hits(48, 36);
            EXPECT_NEAR(middle.row, (89.0 - latitude) / 2.0, 0.01) << latitude;
            EXPECT_NEAR(middle.col, (20.0 + 179.0) / 2.0, 0.1) << latitude;
        }
    }
}

TEST_F(GlobeFile, has_no_hole_in_the_exact_picture_where_it_is_streamed) {
    write(720, 360); // more than a megabyte holds
    for (const char* camera : cameras) {
        EXPECT_EQ(holes(camera, {"--truth", "--memory", "1"}), 0) << camera;
    }
}

TEST_F(GlobeFile, info_tells_the_size_and_extent_of_the_file) {
    for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--memory", "1"}}) {
        std::vector<std::string> arguments{"info", path(), "--json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const auto result = test::reljef(arguments, options_);
        ASSERT_EQ(result.exit_code, 0) << result.err;
        const auto info = nlohmann::json::parse(result.out);
        EXPECT_EQ(info["cols"], 180);
        EXPECT_EQ(info["rows"], 90);
        const int reduction = info["read"]["reduction"].get<int>();
        EXPECT_EQ(info["read"]["cols"], 180 / reduction) << "without the column that closes it";
        EXPECT_EQ(info["read"]["rows"], 90 / reduction) << "without the poles";
        const double half = 1.0 * reduction;
        EXPECT_NEAR(info["extent"]["west"], -180.0 + half, 1e-9);
        EXPECT_NEAR(info["extent"]["east"], 180.0 - half, 1e-9);
        EXPECT_NEAR(info["extent"]["south"], -90.0 + half, 1e-9);
        EXPECT_NEAR(info["extent"]["north"], 90.0 - half, 1e-9);
    }
}

TEST_F(GlobeFile, heights_run_on_across_the_antimeridian) {
    const auto west = test::reljef({"height", path(), "--at", "10,180"}, options_);
    const auto east = test::reljef({"height", path(), "--at", "10,-180"}, options_);
    ASSERT_EQ(west.exit_code, 0) << west.err;
    EXPECT_EQ(west.out.substr(west.out.rfind(',')), east.out.substr(east.out.rfind(',')));
}

} // namespace
} // namespace reljef
