#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "tests/app/command_line.h"
#include "tests/support/temporary_folder.h"

namespace reljef {
namespace {

using test::expect_refusal;

// A ridge: cells that are no planes.
constexpr const char* ridge_dem = "ncols 5\nnrows 4\nxllcorner 0\nyllcorner 0\ncellsize 10\n"
                                  "0 2 9 3 1\n1 4 12 2 0\n0 3 15 5 2\n2 1 8 4 3\n";

class TruthOption : public testing::Test {
protected:
    Image picture(std::vector<std::string> more) {
        std::vector<std::string> arguments{"render",
                                           dem_,
                                           "--size",
                                           "160x120",
                                           "--quiet",
                                           "-o",
                                           (folder_.path() / "a.png").string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const auto result = test::reljef(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        auto image = io::read_image(folder_.path() / "a.png");
        EXPECT_TRUE(image);
        return image ? std::move(*image) : Image();
    }
    HitBuffer hits(std::vector<std::string> more) {
        std::vector<std::string> arguments{
            "render",   dem_,      "--size",
            "160x120",  "--quiet", "--pose",
            "overview", "--hit",   (folder_.path() / "a.exr").string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const auto result = test::reljef(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        auto read = io::read_hits(folder_.path() / "a.exr");
        EXPECT_TRUE(read);
        return read ? std::move(*read) : HitBuffer();
    }

    test::TemporaryFolder folder_;
    std::string dem_ = folder_.write("dem.asc", ridge_dem).string();
};

TEST_F(TruthOption, ShowsWhatPolygonsShowButForTheirTriangles) {
    const HitBuffer exact = hits({"--truth"});
    const HitBuffer polygons = hits({"--context", "osmesa"});
    int terrain = 0;
    int elsewhere = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        const Hit a = exact.samples()[i];
        const Hit b = polygons.samples()[i];
        terrain += a.is_sky() ? 0 : 1;
        elsewhere +=
            a.is_sky() != b.is_sky() || std::hypot(a.col - b.col, a.row - b.row) > 0.5 ? 1 : 0;
    }
    EXPECT_GT(terrain, 3000);
    EXPECT_LT(elsewhere, terrain / 20); // silhouettes of triangles
    EXPECT_GT(elsewhere, 0) << "cells that are no planes differ";
}

TEST_F(TruthOption, HitsLieOnTheBilinearSurface) {
    const HitBuffer exact = hits({"--truth"});
    const double h[4][5] = {{0, 2, 9, 3, 1}, {1, 4, 12, 2, 0}, {0, 3, 15, 5, 2}, {2, 1, 8, 4, 3}};
    for (const Hit& hit : exact.samples()) {
        if (hit.is_sky()) {
            continue;
        }
        const int c = std::clamp(static_cast<int>(hit.col), 0, 3);
        const int r = std::clamp(static_cast<int>(hit.row), 0, 2);
        const double u = static_cast<double>(hit.col) - c;
        const double v = static_cast<double>(hit.row) - r;
        const double expected = (1 - u) * (1 - v) * h[r][c] + u * (1 - v) * h[r][c + 1] +
                                (1 - u) * v * h[r + 1][c] + u * v * h[r + 1][c + 1];
        // Rounding col, row and height to float: slopes are below 12 m a sample.
        ASSERT_NEAR(hit.height, expected, 1e-5);
    }
}

TEST_F(TruthOption, MoreRaysSmoothTheSilhouetteAndLittleElse) {
    const Image one = picture({"--truth"});
    const Image many = picture({"--truth", "--rays", "4"});
    int different = 0;
    for (std::size_t i = 0; i < one.size(); ++i) {
        different += std::abs(one.samples()[i].g - many.samples()[i].g) > 16 ? 1 : 0;
    }
    EXPECT_GT(different, 20);
    EXPECT_LT(different, static_cast<int>(one.size()) / 10);
}

TEST_F(TruthOption, IsTheSameWithAnyNumberOfThreads) {
    const Image one = picture({"--truth", "--threads", "1"});
    const Image three = picture({"--truth", "--threads", "3"});
    EXPECT_TRUE(std::equal(one.samples().begin(), one.samples().end(), three.samples().begin()));
}

TEST_F(TruthOption, HasShadowsByRaysWithATechniqueThatCastsThem) {
    EXPECT_EQ(picture({"--truth", "--technique", "exact"}), picture({"--truth"}));
    EXPECT_NE(picture({"--truth", "--technique", "exact:shadow=hard", "--sun", "90,5"}),
              picture({"--truth", "--sun", "90,5"}));
}

TEST_F(TruthOption, NeedsNoContext) {
    test::ProgramOptions options;
    options.environment = {{"DISPLAY", std::nullopt}};
    const auto result = test::reljef({"render", dem_, "--truth", "--stats", "--size", "64x48", "-o",
                                      (folder_.path() / "b.png").string()},
                                     options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find("exact rays"), std::string::npos) << result.out;
}

TEST_F(TruthOption, RefusesWhatMakesNoSenseWithRays) {
    const std::string file = (folder_.path() / "a.png").string();
    for (const std::vector<std::string>& more : {std::vector<std::string>{"--truth", "--wireframe"},
                                                 {"--truth", "--technique", "texture"},
                                                 {"--truth", "--technique", "exact:shadow=soft"},
                                                 {"--truth", "--context", "osmesa"},
                                                 {"--truth", "--samples", "4"},
                                                 {"--rays", "2"},
                                                 {"--truth", "--rays", "0"},
                                                 {"--truth", "--rays", "17"},
                                                 {"--truth", "--rays", "x"}}) {
        std::vector<std::string> arguments{"render", dem_, "-o", file};
        arguments.insert(arguments.end(), more.begin(), more.end());
        expect_refusal(test::reljef(arguments), 2,
                       {more.back().starts_with("--") ? more.back() : more[more.size() - 2]});
    }
}

} // namespace
} // namespace reljef
