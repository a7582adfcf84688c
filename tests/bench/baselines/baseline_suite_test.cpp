#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/bench/bench_program.h"
#include "tests/support/temporary_folder.h"

namespace reljef {
namespace {

// 33 × 33 hills.
std::string hills_dem() {
    std::string text = "ncols 33\nnrows 33\nxllcorner 0\nyllcorner 0\ncellsize 10\n";
    for (int row = 0; row < 33; ++row) {
        for (int col = 0; col < 33; ++col) {
            text += std::to_string(20.0 * std::sin(0.3 * col) * std::cos(0.2 * row)) + ' ';
        }
        text += '\n';
    }
    return text;
}

bool has_irrlicht() {
    return std::filesystem::exists(std::filesystem::path(RELJEF_BENCH_BINARY).parent_path() /
                                   "reljef-bench-irrlicht");
}

TEST(BenchPeers, WithoutADisplayIsOneLine) {
    const test::TemporaryFolder folder;
    const auto dem = folder.write("dem.asc", hills_dem()).string();
    test::ProgramOptions nowhere;
    nowhere.environment = {{"DISPLAY", std::nullopt}, {"WAYLAND_DISPLAY", std::nullopt}};
    const auto result = test::run_program(
        RELJEF_BENCH_BINARY, {"peers", "--terrain", dem, "--quiet", "--rounds", "1"}, nowhere);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.err.rfind("reljef-bench: ", 0), 0U) << result.err;
    EXPECT_EQ(result.out, "");
}

TEST(BenchPeers, WithoutIrrlichtSaysHowToGetIt) {
    const test::TemporaryFolder folder;
    const auto dem = folder.write("dem.asc", hills_dem()).string();
    const auto alone = folder.path() / "reljef-bench";
    std::filesystem::copy_file(RELJEF_BENCH_BINARY, alone);
    const auto result = test::run_program(alone, {"peers", "--terrain", dem, "--quiet"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, testing::HasSubstr("apt-get install libirrlicht-dev"));
}

TEST(BenchPeers, TooFewSamplesForItAreTold) {
    const test::TemporaryFolder folder;
    const auto dem = folder.write("dem.asc", test::small_dem).string();
    const auto result = test::reljef_bench({"peers", "--terrain", dem, "--quiet"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, testing::HasSubstr("17x17"));
}

TEST(BenchPeers, BothShowTheSameTerrain) {
    const std::filesystem::path xvfb = "/usr/bin/xvfb-run";
    if (!has_irrlicht() || !std::filesystem::exists(xvfb)) {
        GTEST_SKIP() << "needs Irrlicht and xvfb-run";
    }
    const test::TemporaryFolder folder;
    const auto dem = folder.write("dem.asc", hills_dem()).string();
    const auto json = folder.path() / "peers.json";
    const auto result =
        test::run_program(xvfb, {"-a", RELJEF_BENCH_BINARY, "peers", "--terrain", dem, "--size",
                                 "160x120", "--rounds", "2", "--quiet", "--json", json.string()});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto report = nlohmann::json::parse(test::read_bytes(json));
    EXPECT_EQ(report.at("complete"), true);
    ASSERT_EQ(report.at("rows").size(), 18U);
    for (std::size_t i = 0; i < 18; i += 9) {
        const auto& irrlicht = report.at("rows").at(i); // with a vertex for every sample
        const auto& polygons = report.at("rows").at(i + 5);
        EXPECT_EQ(irrlicht.at("triangles"), 2048);
        EXPECT_EQ(irrlicht.at("what"), "irrlicht:lods=1");
        EXPECT_EQ(polygons.at("what"), "polygons:lods=1");
        EXPECT_NEAR(irrlicht.at("reprojection_px").at("rms").get<double>(),
                    polygons.at("reprojection_px").at("rms").get<double>(), 0.1);
        EXPECT_NEAR(irrlicht.at("reprojection_px").at("count").get<double>(),
                    polygons.at("reprojection_px").at("count").get<double>(), 200.0);
        for (std::size_t row = i; row < i + 9; ++row) {
            EXPECT_EQ(report.at("rows").at(row).at("camera"), row < i + 6 ? "still" : "moving");
        }
        EXPECT_EQ(report.at("rows").at(i + 6).at("what"), "irrlicht:lods=5");
        EXPECT_EQ(report.at("rows").at(i + 7).at("what"), "polygons:error=1");
    }
}

} // namespace
} // namespace reljef
