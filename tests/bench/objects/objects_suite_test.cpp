#include "bench/objects/objects_suite.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/report/report_json.h"
#include "bench/report/report_table.h"
#include "tests/bench/bench_program.h"
#include "tests/io/footprints/made_footprints.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

using testing::Contains;
using testing::HasSubstr;

ObjectsOptions small_city() {
    ObjectsOptions options;
    options.suite.size = {128, 96};
    options.suite.context = session::BackendKind::osmesa;
    options.suite.quiet = true;
    options.suite.rounds = 1;
    options.sizes = {200};
    options.distances = {120.0};
    options.downs = {40.0};
    return options;
}

const Row& row_of(const Results& results, const std::string& label) {
    const auto found = std::find_if(results.rows.begin(), results.rows.end(), [&](const Row& row) {
        return row.setting.label == label && !row.null_row;
    });
    EXPECT_NE(found, results.rows.end()) << label;
    return found != results.rows.end() ? *found : results.rows.front();
}

TEST(ObjectsSuite, MeshesAreTheTruthAndHeightsAreBesideIt) {
    const Results results = run_objects(small_city(), {});
    ASSERT_FALSE(results.stopped) << results.stopped->message;
    ASSERT_EQ(results.rows.size(), 9U) << "eight, and one for the noise floor";
    const Row& meshes = row_of(results, "meshes: polygons:error=1");
    const Row& exact = row_of(results, "heights: exact");
    const Row& texture = row_of(results, "heights: texture");
    const auto rms = [](const Row& row) { return row.error->hit_texels->distribution.rms; };
    EXPECT_LT(meshes.error->wrong_percent, 1.0) << "the bare ground may be a pixel off, 2 samples";
    EXPECT_LT(meshes.error->wrong_percent, exact.error->wrong_percent);
    EXPECT_LT(exact.error->wrong_percent, texture.error->wrong_percent);
    EXPECT_LT(rms(exact), rms(texture));
    EXPECT_GT(meshes.objects->buildings, 0U);
    EXPECT_EQ(meshes.objects->form, "meshes");
    EXPECT_EQ(meshes.objects->distance, 120.0);
    EXPECT_GT(meshes.objects->bytes, 10'000U);
    EXPECT_GT(meshes.timing.stats.triangles, 100U);
}

TEST(ObjectsSuite, RaysOnTheCpuAreMeasuredBesideOpenGl) {
    ObjectsOptions options = small_city();
    options.suite.context = session::BackendKind::cpu;
    const Results results = run_objects(options, {});
    ASSERT_FALSE(results.stopped) << results.stopped->message;
    for (const char* const label : {"heights: exact", "meshes: polygons:error=1"}) {
        const Row& by_opengl = row_of(results, label);
        const Row& by_rays = row_of(results, std::string(label) + " on cpu");
        EXPECT_GT(by_rays.timing.stats.rays, 0U) << label;
        EXPECT_EQ(by_opengl.timing.stats.rays, 0U) << label;
        EXPECT_LE(by_rays.error->wrong_percent, by_opengl.error->wrong_percent + 0.5) << label;
    }
    const auto cpu = [](const Row& row) { return row.setting.label.ends_with(" on cpu"); };
    EXPECT_EQ(std::count_if(results.rows.begin(), results.rows.end(), cpu), 5)
        << "exact, triangles, auto, meshes, meshes alone";
}

TEST(ObjectsSuite, IsWrittenInTheOneSchemaAndReadAgain) {
    const Results results = run_objects(small_city(), {});
    const test::TemporaryFolder folder;
    const auto file = folder.write("objects.json", json_report(results));
    const auto read = read_json_report(file);
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(read->rows.size(), results.rows.size());
    EXPECT_EQ(read->rows[1].objects->bytes, results.rows[1].objects->bytes);
    EXPECT_EQ(read->rows[1].objects->form, "heights");
    const auto tables = report_tables(*read);
    ASSERT_EQ(tables.size(), 1U);
    EXPECT_THAT(tables[0].heading, HasSubstr("from 120 m, 40 degrees down"));
    EXPECT_THAT(tables[0].heading, Not(HasSubstr("overview")));
    EXPECT_EQ(tables[0].columns.size(), tables[0].lines[0].size());
}

TEST(ObjectsSuite, WhatCannotBeMeasuredIsNotedAndTheRestIsMeasured) {
    ObjectsOptions options = small_city();
    const test::TemporaryFolder folder;
    options.terrains = {(folder.path() / "absent.toml").string(), "urban"};
    options.distances = {0.5, 120.0};
    options.downs = {1.0};
    options.sizes = {200};
    const Results results = run_objects(options, {});
    EXPECT_FALSE(results.rows.empty());
    ASSERT_TRUE(results.stopped);
    EXPECT_THAT(results.stopped->message, HasSubstr("absent.toml"));
}

TEST(ObjectsSuite, WithoutAnyCityTheReasonsAreTheError) {
    ObjectsOptions options = small_city();
    options.terrains = {"absent.toml"};
    const Results results = run_objects(options, {});
    ASSERT_TRUE(results.stopped);
    EXPECT_THAT(results.stopped->message, HasSubstr("absent.toml"));
}

TEST(ObjectsSuite, SceneFilesWithFootprintsOnASurfaceModelAreCities) {
    const test::TemporaryFolder folder;
    std::string ground = "ncols 61\nnrows 61\nxllcenter 7\nyllcenter 45\ncellsize 0.00001\n";
    std::string surface = ground;
    for (int row = 0; row < 61; ++row) {
        for (int col = 0; col < 61; ++col) {
            const bool is_building = col >= 20 && col <= 40 && row >= 25 && row <= 35;
            const bool is_tree = col >= 10 && col <= 50 && row >= 40 && row <= 45;
            ground += "5 ";
            surface += is_building ? "17 " : is_tree ? "13 " : "5 ";
        }
        ground += "\n";
        surface += "\n";
    }
    const char* wgs84 =
        R"(GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,)"
        R"(298.257223563]],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]])";
    folder.write("ground.prj", wgs84);
    folder.write("surface.prj", wgs84);
    folder.write("ground.asc", ground);
    folder.write("surface.asc", surface);
    folder.write("houses.geojson",
                 test::footprints_text({test::polygon_feature(
                     "[" + test::rectangle(7.000195, 45.000245, 7.000405, 45.000355) + "]")}));
    ObjectsOptions options = small_city();
    options.terrains = {folder
                            .write("city.toml",
                                   "[terrain]\nheights = \"ground.asc\"\n[[footprints]]\n"
                                   "file = \"houses.geojson\"\nsurface = "
                                   "\"surface.asc\"\n")
                            .string()};
    options.distances = {60.0};
    const Results results = run_objects(options, {});
    ASSERT_FALSE(results.stopped) << results.stopped->message
                                  << testing::PrintToString(results.notes);
    EXPECT_EQ(results.rows.size(), 8U) << "no meshes alone";
    EXPECT_EQ(results.rows[0].objects->buildings, 1U);
    const Row& exact = row_of(results, "heights: exact");
    EXPECT_LT(exact.error->hit_texels->distribution.median, 1.0);
    EXPECT_LT(exact.error->wrong_percent, 5.0) << "trees of the scan are no part of the city";
    EXPECT_THAT(results.notes, Contains(HasSubstr("at 6.6 % of the samples")));
}

} // namespace
} // namespace reljef::bench
