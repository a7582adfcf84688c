#include "bench/suites/tables_suite.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/bench/bench_program.h"
#include "tests/scene/technique/terrain_techniques.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

using nlohmann::json;

class TablesSuite : public testing::Test {
protected:
    TablesOptions small_options() {
        TablesOptions options;
        options.terrains = {folder_.write("a.asc", test::small_dem).string(),
                            folder_.write("b.asc", test::small_dem).string()};
        options.suite.size = {64, 48};
        options.suite.context = session::BackendKind::osmesa;
        options.suite.rounds = 6;
        options.suite.quiet = true;
        return options;
    }

    /// Of small_options(), measured once.
    const Results& small_results() {
        static const Results measured = run_tables(small_options(), {});
        return measured;
    }

    test::TemporaryFolder folder_;
};

TEST_F(TablesSuite, has_every_technique_and_the_null_row_of_every_terrain) {
    const Results& results = small_results();
    ASSERT_FALSE(results.stopped) << results.stopped->message;
    const std::size_t techniques = scene::terrain_techniques().size();
    ASSERT_EQ(results.rows.size(), 2 * (techniques + 1));
    for (std::size_t i = 0; i < results.rows.size(); ++i) {
        const Row& row = results.rows[i];
        const std::size_t place = i % (techniques + 1);
        EXPECT_EQ(row.scene, i <= techniques ? "a.asc" : "b.asc");
        EXPECT_EQ(row.null_row, place == techniques);
        EXPECT_EQ(row.setting.technique,
                  row.null_row ? "texture" : scene::terrain_techniques()[place].name);
        EXPECT_EQ(row.timing.frames, 6U);
        EXPECT_GT(row.timing.ms.median, 0.0);
        EXPECT_LE(row.timing.interval->low, row.timing.ms.median);
        EXPECT_GE(row.timing.interval->high, row.timing.ms.median);
        EXPECT_LE(row.timing.ms.median, row.timing.ms.p95);
        EXPECT_LE(row.timing.fps_1_percent_low, 1000.0 / row.timing.ms.median);
        EXPECT_TRUE(row.timing.noise_floor.has_value());
        EXPECT_GT(row.timing.stats.triangles, 0U);
    }
}

TEST_F(TablesSuite, draws_each_row_with_its_own_technique) {
    const Results& results = small_results();
    ASSERT_FALSE(results.stopped);
    for (const Row& row : results.rows) { // one flat square, 2 by 2 cells, or a box
        const auto technique = scene::parse_technique(row.setting.label).value();
        if (technique.id() == scene::TechniqueId::automatic) {
            continue; // it chooses
        }
        const auto geometry = scene::geometry_of(technique.id());
        EXPECT_EQ(row.timing.stats.triangles, geometry == scene::Geometry::flat   ? 2U
                                              : geometry == scene::Geometry::full ? 8U
                                                                                  : 12U);
    }
}

TEST_F(TablesSuite, views_that_move_or_start_cold_say_so_and_cut_triangles_anew) {
    TablesOptions options = small_options();
    options.techniques = {scene::parse_technique("polygons:error=1").value()};
    for (const std::string test : {"", "moving", "cold"}) {
        options.suite.moving = test == "moving";
        options.suite.cold = test == "cold";
        const Results results = run_tables(options, {});
        ASSERT_FALSE(results.stopped);
        for (const Row& row : results.rows) {
            EXPECT_EQ(row.test, test);
            if (row.setting.technique == "polygons") {
                EXPECT_EQ(row.timing.stats.tiles_cut > 0, !test.empty());
            }
        }
    }
}

TEST(TablesCommand, ViewsEitherMoveOrStartCold) {
    const auto run = test::reljef_bench({"tables", "--moving", "--cold"});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_EQ(run.err,
              "reljef-bench: --moving, --cold: both found, one was expected (see --help)\n");
}

TEST_F(TablesSuite, warm_frames_upload_no_terrain) {
    const Results& results = small_results();
    ASSERT_FALSE(results.stopped);
    for (const Row& row : results.rows) {
        const bool is_warped = row.setting.technique == "prewarp"; // for each camera position
        EXPECT_LE(row.timing.stats.uploads, is_warped ? 2 : 1);    // the camera
        EXPECT_GT(row.timing.stats.skipped.uploads_unchanged, 0);
    }
}

TEST_F(TablesSuite, ratio_is_to_texture_on_the_same_terrain) {
    const Results& results = small_results();
    ASSERT_FALSE(results.stopped);
    const std::size_t rows_a_terrain = results.rows.size() / 2;
    for (std::size_t i = 0; i < results.rows.size(); ++i) {
        const Row& texture = results.rows[i / rows_a_terrain * rows_a_terrain];
        EXPECT_EQ(texture.timing.ratio_to_texture, 1.0);
        EXPECT_DOUBLE_EQ(*results.rows[i].timing.ratio_to_texture,
                         results.rows[i].timing.ms.median / texture.timing.ms.median);
    }
}

TEST_F(TablesSuite, texture_is_measured_beside_the_technique_asked_for) {
    auto options = small_options();
    options.terrains.resize(1);
    options.techniques = {scene::make_technique(scene::TechniqueId::polygons)};
    const Results results = run_tables(options, {});
    ASSERT_EQ(results.rows.size(), 3U);
    EXPECT_EQ(results.rows[0].setting.label, "texture");
    EXPECT_EQ(results.rows[1].setting.label, "polygons:lods=1");
    EXPECT_TRUE(results.rows[2].null_row);
}

// The DEM is a plane: triangles draw it exactly, a flat surface is metres off.
TEST_F(TablesSuite, every_row_tells_its_error) {
    const Results& results = small_results();
    ASSERT_FALSE(results.stopped);
    for (const Row& row : results.rows) {
        ASSERT_TRUE(row.error && row.error->reprojection_px);
        const double rms = row.error->reprojection_px->distribution.rms;
        if (row.setting.technique == "polygons") {
            EXPECT_LT(rms, 0.01);
            EXPECT_LT(row.error->wrong_percent, 0.5);
        } else if (row.setting.technique == "texture") {
            EXPECT_GT(rms, 1.0);
        } else if (row.setting.technique == "exact") {
            EXPECT_LT(rms, 0.01);
        }
        EXPECT_FALSE(row.view);
    }
}

TEST_F(TablesSuite, gallery_is_its_tiles_each_technique_with_its_error_where_it_suits) {
    RELJEF_RELEASE_ONLY("the suite has tests on terrains, the tiles' truth and programs their own");
    auto options = small_options();
    options.terrains = {"gallery"};
    options.suite.rounds = 1;
    for (const char* const technique : {"exact", "bump", "multi-layer:n=64"}) {
        options.techniques.push_back(scene::parse_technique(technique).value());
    }
    const Results results = run_tables(options, {});
    ASSERT_FALSE(results.stopped) << results.stopped->message;
    ASSERT_EQ(results.rows.size(), 4U + 3U); // brick, rings; texture and its null row on each
    for (const Row& row : results.rows) {
        EXPECT_EQ(row.pose, scene::Pose::oblique);
        ASSERT_TRUE(row.error && row.error->reprojection_px);
        const double rms = row.error->reprojection_px->distribution.rms;
        if (row.setting.technique == "exact") { // the rounding of float texture coordinates
            EXPECT_LT(rms, 0.01);
            EXPECT_LT(row.error->wrong_percent, 0.05);
        } else if (row.setting.technique == "multi-layer") {
            EXPECT_EQ(row.scene, "tile rings");
            EXPECT_LT(rms, 1.0);
        } else {
            EXPECT_GT(rms, 0.1) << row.scene; // flat techniques
        }
    }
}

TEST_F(TablesSuite, scene_file_of_the_gallery_is_refused_at_once) {
    auto options = small_options();
    options.terrains = {
        folder_.write("halls.toml", "[terrain]\ngenerator = \"gallery\"\n").string()};
    const Results results = run_tables(options, {});
    ASSERT_TRUE(results.stopped);
    EXPECT_THAT(results.stopped->message, testing::HasSubstr("halls.toml: the gallery found"));
    EXPECT_TRUE(results.rows.empty());
}

TEST_F(TablesSuite, views_are_kept_where_they_are_asked_for) {
    auto options = small_options();
    options.suite.keep_views = true;
    const Results results = run_tables(options, {});
    ASSERT_FALSE(results.stopped);
    for (const Row& row : results.rows) {
        EXPECT_EQ(row.view == nullptr, row.null_row);
        if (row.view) {
            EXPECT_EQ(row.view->size, glm::ivec2(64, 48));
        }
    }
    EXPECT_EQ(results.rows[0].view->truth, results.rows[1].view->truth);
}

TEST_F(TablesSuite, environment_is_written_down) {
    auto options = small_options();
    options.suite.threads = 1;
    const Environment environment = run_tables(options, {}).environment;
    EXPECT_THAT(environment.renderer, testing::HasSubstr("llvmpipe"));
    EXPECT_THAT(environment.gl, testing::StartsWith("4.5"));
    EXPECT_EQ(environment.context, "osmesa");
    EXPECT_EQ(environment.threads, 1U);
    EXPECT_FALSE(environment.cpu.empty());
    EXPECT_FALSE(environment.commit.empty());
    EXPECT_EQ(environment.costs, "built-in");
}

TEST_F(TablesSuite, terrain_that_cannot_be_opened_costs_the_others_nothing) {
    auto options = small_options();
    options.terrains.emplace_back("atlantis");
    const Results results = run_tables(options, {});
    EXPECT_FALSE(results.rows.empty());
    ASSERT_TRUE(results.stopped);
    EXPECT_THAT(results.stopped->message, testing::HasSubstr("atlantis"));
}

TEST_F(TablesSuite, terrains_of_one_file_name_are_told_apart_by_their_paths) {
    const test::TemporaryFolder other;
    auto options = small_options();
    options.terrains[1] = other.write("a.asc", test::small_dem).string();
    options.techniques = {scene::make_technique(scene::TechniqueId::polygons)};
    const Results results = run_tables(options, {});
    ASSERT_EQ(results.rows.size(), 6U);
    EXPECT_EQ(results.rows[0].scene, options.terrains[0]);
    EXPECT_EQ(results.rows[3].scene, options.terrains[1]);
}

TEST_F(TablesSuite, stop_at_once_gives_no_rows_and_says_why) {
    std::stop_source stop;
    stop.request_stop();
    const Results results = run_tables(small_options(), stop.get_token());
    EXPECT_TRUE(results.rows.empty());
    ASSERT_TRUE(results.stopped);
    EXPECT_THAT(results.stopped->message, testing::HasSubstr("interrupted"));
}

TEST(BenchProgram, prints_the_table_and_writes_the_json) {
    const test::TemporaryFolder folder;
    const auto dem = folder.write("dem.asc", test::small_dem).string();
    const auto file = folder.path() / "t.json";
    const auto result =
        test::reljef_bench({"tables", "--terrain", dem, "--size", "64x48", "--context", "osmesa",
                            "--rounds", "5", "--quiet", "--json", file.string()});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    for (const char* part :
         {"dem.asc", "texture", "polygons:lods=1", "noise floor", "error px", "llvmpipe"}) {
        EXPECT_THAT(result.out, testing::HasSubstr(part));
    }
    const json report = json::parse(test::read_bytes(file));
    EXPECT_EQ(report.at("schema"), "reljef-bench/1");
    EXPECT_EQ(report.at("rows").size(), scene::terrain_techniques().size() + 1);
    EXPECT_EQ(report.at("rows").at(0).at("frames"), 5);
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"dem.asc", "t.json"}));
}

TEST(BenchProgram, help_names_the_suites) {
    const auto result = test::reljef_bench({"--help"});
    EXPECT_EQ(result.exit_code, 0);
    for (const char* present :
         {"tables", "pareto", "lod", "peers", "flight", "stress", "compare"}) {
        EXPECT_THAT(result.out, testing::HasSubstr(present));
    }
    EXPECT_THAT(result.out,
                testing::HasSubstr("Exit status: 0 success; 1 failure, or ended by Ctrl-C"));
}

} // namespace
} // namespace reljef::bench
