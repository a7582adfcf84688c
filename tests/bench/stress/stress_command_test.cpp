#include <filesystem>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/stress/stress_run.h"
#include "tests/bench/bench_program.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

using testing::HasSubstr;
using testing::Not;

// The fixed subset that guards every change; a minute at most on two quiet processors.
TEST(StressCommand, QuickFindsNoFigureOverItsLimit) {
    RELJEF_RELEASE_ONLY("it is the product's own stress test");
    const test::TemporaryFolder folder;
    const auto file = folder.path() / "stress.json";
    const auto result = test::reljef_bench(
        {"stress", "--quick", "--quiet", "--context", "osmesa", "--json", file.string()});
    EXPECT_EQ(result.exit_code, 0) << result.err << result.out;
    const auto report = nlohmann::json::parse(test::read_bytes(file));
    EXPECT_EQ(report.at("summary").at("over"), 0);
    std::set<std::string> stresses;
    std::set<std::string> techniques;
    for (const auto& row : report.at("rows")) {
        stresses.insert(row.at("stress").get<std::string>());
        if (row.at("stress") == "standard pose") {
            techniques.insert(row.at("technique").get<std::string>());
        }
    }
    EXPECT_EQ(techniques.size(), stressed_techniques({}).size());
    EXPECT_EQ(stresses, (std::set<std::string>{
                            "camera path", "contexts", "creeping camera", "depth order",
                            "detail texture", "error bound, near ground, plane",
                            "error bound, random, plane", "eye near the ground", "geodesy",
                            "grazing view", "hard camera", "moved scene", "odd file", "odd heights",
                            "repeat", "scale", "standard pose", "tangent frames"}));
}

// Skips over the higher half of each block of cells, so that rays pass peaks.
TEST(StressCommand, AShaderThatPassesPeaksFailsIt) {
    RELJEF_RELEASE_ONLY("the same figures as above");
    const test::TemporaryFolder folder;
    std::string shader = test::read_bytes(RELJEF_SOURCE "/shaders/relief/relief_exact.glsl");
    const std::string height = "texelFetch(max_mipmap, walk.block, walk.level).r";
    const auto place = shader.find(height);
    ASSERT_NE(place, std::string::npos);
    shader.replace(place, height.size(), "0.5 * " + height);
    folder.write("shaders/relief/relief_exact.glsl", shader);
    const auto result = test::reljef_bench({"stress", "--quick", "--quiet", "--context", "osmesa",
                                            "--only", "standard-pose", "--technique", "exact",
                                            "--shader-dir", (folder.path() / "shaders").string()});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.out, HasSubstr("over their limits:\n  standard pose"));
    EXPECT_THAT(result.err, HasSubstr("over their limits found, none were expected"));
}

TEST(StressCommand, WritesThePageAndTheReportOfWhatWasAsked) {
    const test::TemporaryFolder folder;
    const auto file = folder.path() / "stress.json";
    const auto page = folder.path() / "page";
    const auto result = test::reljef_bench({"stress", "--quick", "--quiet", "--context", "osmesa",
                                            "--only", "tangent-frames", "--only", "depth-order",
                                            "--json", file.string(), "--html", page.string()});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const auto report = nlohmann::json::parse(test::read_bytes(file));
    std::set<std::string> stresses;
    for (const auto& row : report.at("rows")) {
        stresses.insert(row.at("stress").get<std::string>());
    }
    EXPECT_EQ(stresses, (std::set<std::string>{"tangent frames", "depth order"}));
    EXPECT_THAT(test::read_bytes(page / "index.html"), HasSubstr("\"suite\": \"stress\""));
}

TEST(StressCommand, MadeFilesAreNamedWithoutTheirTemporaryFolder) {
    const test::TemporaryFolder folder;
    const auto file = folder.path() / "stress.json";
    const auto result =
        test::reljef_bench({"stress", "--quick", "--quiet", "--context", "osmesa", "--only",
                            "odd-file", "--technique", "texture", "--json", file.string()});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::string report = test::read_bytes(file);
    EXPECT_THAT(report, HasSubstr("all-void.asc"));
    EXPECT_THAT(report, Not(HasSubstr(std::filesystem::temp_directory_path().string())));
}

TEST(StressCommand, ChecksTheErrorBoundFromAsManyPosesAsAskedFor) {
    const test::TemporaryFolder folder;
    const auto file = folder.path() / "stress.json";
    const auto result =
        test::reljef_bench({"stress", "--quick", "--quiet", "--context", "osmesa", "--only",
                            "error-bound", "--poses", "7", "--json", file.string()});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    int frames = 0;
    const auto report = nlohmann::json::parse(test::read_bytes(file));
    for (const auto& row : report.at("rows")) {
        if (row.at("figure") == "holes") {
            frames += std::stoi(row.at("at").get<std::string>());
        }
    }
    EXPECT_EQ(frames, 2 * 7) << "by triangles, and by auto";
}

TEST(StressCommand, AnUnknownStressIsNamed) {
    const auto result = test::reljef_bench({"stress", "--only", "poles"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr("poles"));
}

TEST(StressCommand, ATechniqueThatDrawsNoTerrainIsNamed) {
    const auto result = test::reljef_bench({"stress", "--technique", "lattice"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr("lattice found, a technique that draws terrains was"));
}

} // namespace
} // namespace reljef::bench
