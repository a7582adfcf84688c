#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <vector>

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

const std::filesystem::path xvfb = "/usr/bin/xvfb-run";

std::filesystem::path beside_bench(std::string_view name) {
    return std::filesystem::path(RELJEF_BENCH_BINARY).parent_path() / name;
}

bool has_irrlicht() {
    return std::filesystem::exists(beside_bench("reljef-bench-irrlicht"));
}

bool has_povray() {
    return std::filesystem::exists("/usr/bin/povray");
}

nlohmann::json read_report(const std::filesystem::path& json) {
    return nlohmann::json::parse(test::read_bytes(json), nullptr, false);
}

// A script in place of another program.
void write_script(const test::TemporaryFolder& folder, const char* name, const std::string& lines) {
    const auto path = folder.write(name, "#!/bin/sh\n" + lines);
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
}

// `peers` of a copy of the program in `folder`, where other programs may lie, too. Only there is
// povray searched for.
test::ProgramResult peers_alone(const test::TemporaryFolder& folder, const std::string& json) {
    const auto dem = folder.write("dem.asc", hills_dem()).string();
    const auto alone = folder.path() / "reljef-bench";
    std::filesystem::copy_file(RELJEF_BENCH_BINARY, alone);
    return test::run_program(xvfb, {"-a", "/usr/bin/env", "PATH=" + folder.path().string(),
                                    alone.string(), "peers", "--terrain", dem, "--size", "80x60",
                                    "--rounds", "1", "--json", json});
}

bool has_levels(const nlohmann::json& row) {
    return row.at("work") == "triangles with levels or an error bound";
}

std::set<std::string> other_names(const nlohmann::json& report) {
    std::set<std::string> names;
    for (const auto& row : report.at("rows")) {
        if (!has_levels(row)) {
            names.insert(row.at("what").get<std::string>());
        }
    }
    return names;
}

// Rows with levels or an error bound.
std::vector<nlohmann::json> level_rows(const nlohmann::json& report) {
    std::vector<nlohmann::json> rows;
    std::copy_if(report.at("rows").begin(), report.at("rows").end(), std::back_inserter(rows),
                 has_levels);
    return rows;
}

std::string all_notes(const nlohmann::json& report) {
    std::string notes;
    for (const auto& note : report.at("notes")) {
        notes += note.get<std::string>() + '\n';
    }
    return notes;
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

TEST(BenchPeers, MissingProgramsAreLeftOutAndNotesNameTheirPackages) {
    if (!std::filesystem::exists(xvfb)) {
        GTEST_SKIP() << "needs xvfb-run";
    }
    const test::TemporaryFolder folder;
    const auto json = folder.path() / "peers.json";
    const auto result = peers_alone(folder, json.string());
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto report = read_report(json);
    const std::string notes = all_notes(report);
    for (const char* package : {"libirrlicht-dev", "libopenscenegraph-dev", "povray"}) {
        EXPECT_THAT(notes, testing::HasSubstr(std::string("apt-get install ") + package));
        EXPECT_THAT(result.err, testing::HasSubstr(package));
        EXPECT_THAT(result.out, testing::HasSubstr(package));
    }
    EXPECT_EQ(level_rows(report).size(), 10U); // polygons
    EXPECT_THAT(other_names(report), testing::IsSupersetOf({"Embree, grid", "Embree, quads"}));
    EXPECT_THAT(other_names(report), testing::Not(testing::Contains("POV-Ray, height_field")));
}

TEST(BenchPeers, ProgramsThatDieAreLeftOut) {
    if (!std::filesystem::exists(xvfb)) {
        GTEST_SKIP() << "needs xvfb-run";
    }
    const test::TemporaryFolder folder;
    const auto json = folder.path() / "peers.json";
    write_script(folder, "reljef-bench-irrlicht", "echo failed no window here\n");
    write_script(folder, "reljef-bench-openscenegraph", "echo ok; read line; echo ok; read line\n");
    write_script(folder, "povray", "[ \"$1\" = --version ] || { echo no memory; exit 3; }\n");
    const auto result = peers_alone(folder, json.string());
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto report = read_report(json);
    const std::string notes = all_notes(report);
    EXPECT_THAT(notes, testing::HasSubstr("no window here"));
    EXPECT_THAT(notes, testing::ContainsRegex("OpenSceneGraph.*left out.*it ended"));
    EXPECT_THAT(notes, testing::ContainsRegex("POV-Ray.*left out.*no memory"));
    EXPECT_THAT(other_names(report),
                testing::IsSubsetOf({"Embree, grid", "Embree, quads", "exact", "polygons:lods=1",
                                     "parallax:offset=-0.5", "parallax-limited:offset=-0.5"}));
}

TEST(BenchPeers, APovrayThatWritesNoPictureIsLeftOut) {
    if (!std::filesystem::exists(xvfb)) {
        GTEST_SKIP() << "needs xvfb-run";
    }
    const test::TemporaryFolder folder;
    const auto json = folder.path() / "peers.json";
    write_script(folder, "povray", "echo nothing\n");
    const auto result = peers_alone(folder, json.string());
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(all_notes(read_report(json)),
                testing::ContainsRegex("POV-Ray.*left out.*no picture of 80 x 60"));
}

TEST(BenchPeers, TooFewSamplesForItAreTold) {
    const test::TemporaryFolder folder;
    const auto dem = folder.write("dem.asc", test::small_dem).string();
    const auto result = test::reljef_bench({"peers", "--terrain", dem, "--quiet"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, testing::HasSubstr("17x17"));
}

// All rows of a small run with all programs that are installed.
const nlohmann::json& whole_report() {
    static const nlohmann::json report = [] {
        const test::TemporaryFolder folder;
        const auto dem = folder.write("dem.asc", hills_dem()).string();
        const auto json = folder.path() / "peers.json";
        const auto result = test::run_program(
            xvfb, {"-a", RELJEF_BENCH_BINARY, "peers", "--terrain", dem, "--size", "160x120",
                   "--rounds", "2", "--quiet", "--json", json.string()});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return read_report(json);
    }();
    return report;
}

TEST(BenchPeers, BothShowTheSameTerrain) {
    if (!has_irrlicht() || !std::filesystem::exists(xvfb)) {
        GTEST_SKIP() << "needs Irrlicht and xvfb-run";
    }
    const nlohmann::json& report = whole_report();
    EXPECT_EQ(report.at("complete"), true);
    const auto rows = level_rows(report);
    ASSERT_EQ(rows.size(), 18U);
    for (std::size_t i = 0; i < 18; i += 9) {
        const auto& irrlicht = rows.at(i); // with a vertex for every sample
        const auto& polygons = rows.at(i + 5);
        EXPECT_EQ(irrlicht.at("triangles"), 2048);
        EXPECT_EQ(irrlicht.at("what"), "irrlicht:lods=1");
        EXPECT_EQ(polygons.at("what"), "polygons:lods=1");
        EXPECT_NEAR(irrlicht.at("reprojection_px").at("rms").get<double>(),
                    polygons.at("reprojection_px").at("rms").get<double>(), 0.1);
        EXPECT_NEAR(irrlicht.at("reprojection_px").at("count").get<double>(),
                    polygons.at("reprojection_px").at("count").get<double>(), 200.0);
        for (std::size_t row = i; row < i + 9; ++row) {
            EXPECT_EQ(rows.at(row).at("camera"), row < i + 6 ? "still" : "moving");
        }
        EXPECT_EQ(rows.at(i + 6).at("what"), "irrlicht:lods=5");
        EXPECT_EQ(rows.at(i + 7).at("what"), "polygons:error=1");
    }
}

const nlohmann::json* other_row(const char* pose, const std::string& what) {
    for (const auto& row : whole_report().at("rows")) {
        if (!has_levels(row) && row.at("pose") == pose && row.at("what") == what) {
            return &row;
        }
    }
    return nullptr;
}

double pixels(const nlohmann::json& row, const char* figure) {
    return row.at("reprojection_px").at(figure).get<double>();
}

// Each cell of theirs is two triangles.
void expect_triangles_of_cells(const char* pose, const std::string& what) {
    const nlohmann::json* row = other_row(pose, what);
    ASSERT_NE(row, nullptr) << what;
    EXPECT_LT(row->at("wrong_percent").get<double>(), 1.0) << what << pose;
    EXPECT_LT(pixels(*row, "rms"), pixels(*other_row(pose, "polygons:lods=1"), "rms") + 0.1)
        << what << pose;
    EXPECT_GT(pixels(*row, "count"), 2000.0) << what << pose;
    EXPECT_GT(row->at("ms").at("median").get<double>(), 0.0) << what << pose;
    EXPECT_GT(row->at("times_reljef").get<double>(), 0.0) << what << pose;
}

TEST(BenchPeers, AllTrianglesAndRaysShowTheSameTerrain) {
    if (!std::filesystem::exists(xvfb)) {
        GTEST_SKIP() << "needs xvfb-run";
    }
    std::vector<std::string> names{"polygons:lods=1", "Embree, grid", "Embree, quads", "exact"};
    if (std::filesystem::exists(beside_bench("reljef-bench-openscenegraph"))) {
        names.emplace_back("OpenSceneGraph, GeometryTechnique");
    }
    if (has_povray()) {
        names.emplace_back("POV-Ray, height_field");
    }
    for (const char* pose : {"overview", "low"}) {
        for (const std::string& name : names) {
            expect_triangles_of_cells(pose, name);
        }
    }
}

TEST(BenchPeers, TheParallaxMaterialMovesTexelsAsParallaxDoes) {
    if (!has_irrlicht() || !std::filesystem::exists(xvfb)) {
        GTEST_SKIP() << "needs Irrlicht and xvfb-run";
    }
    const nlohmann::json* theirs = other_row("overview", "Irrlicht, parallax material");
    const nlohmann::json* ours = other_row("overview", "parallax-limited:offset=-0.5");
    ASSERT_NE(ours, nullptr);
    if (theirs == nullptr) {
        GTEST_SKIP() << all_notes(whole_report());
    }
    const auto rms = [](const nlohmann::json& row) {
        return row.at("hit_texels").at("rms").get<double>();
    };
    EXPECT_NEAR(rms(*theirs), rms(*ours), 0.1 * rms(*ours) + 0.05);
    EXPECT_NEAR(theirs->at("wrong_percent").get<double>(), ours->at("wrong_percent").get<double>(),
                5.0);
}

} // namespace
} // namespace reljef
