#include "bench/runner/suite.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/bench/bench_program.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(SettingOf, has_every_parameter_in_its_label) {
    const scene::Technique polygons{scene::Polygons{}};
    const Setting setting = setting_of(polygons);
    EXPECT_EQ(setting.technique, "polygons");
    EXPECT_EQ(setting.label, scene::to_string(polygons));
    EXPECT_EQ(setting.parameters.front().name, "lods");
}

class SuiteOnTinyTerrain : public testing::Test {
protected:
    SuiteOptions options() {
        SuiteOptions options;
        options.size = {64, 48};
        options.context = session::BackendKind::osmesa;
        options.rounds = 3;
        options.quiet = true;
        return options;
    }

    Group group(const std::string& dem, std::vector<std::string> techniques) {
        Group group{"a test", {folder_.write("dem.asc", dem).string()}, scene::Pose::overview, {}};
        for (const std::string& technique : techniques) {
            group.candidates.push_back({scene::parse_technique(technique).value()});
        }
        return group;
    }

    test::TemporaryFolder folder_;
};

TEST_F(SuiteOnTinyTerrain, row_has_the_figures_of_its_own_technique) {
    Group both = group(std::string(test::small_dem), {"texture", "polygons"});
    both.candidates[1].source = SourceFigure{50.0, 2.0, "somewhere"};
    const Results results = run_suite({"a suite", {both}}, options(), {});
    ASSERT_FALSE(results.stopped) << results.stopped->message;
    ASSERT_EQ(results.rows.size(), 3U);
    EXPECT_EQ(results.rows[1].source->fps, 50.0);
    EXPECT_EQ(results.rows[1].test, "a test");
    EXPECT_EQ(results.rows[1].setting.technique, "polygons");
    EXPECT_EQ(results.rows[1].timing.stats.triangles, 8U);
    EXPECT_TRUE(results.rows[2].null_row);
    EXPECT_EQ(results.rows[2].timing.stats.triangles, 2U);
}

TEST_F(SuiteOnTinyTerrain, pose_of_the_group_is_that_of_the_picture) {
    Group from_above = group(std::string(test::small_dem), {"texture", "polygons"});
    Group low = from_above;
    from_above.pose = scene::Pose::map;
    low.pose = scene::Pose::low;
    const Results results = run_suite({"a suite", {from_above, low}}, options(), {});
    ASSERT_FALSE(results.stopped) << results.stopped->message;
    ASSERT_EQ(results.rows.size(), 6U);
    EXPECT_EQ(results.rows[0].pose, scene::Pose::map);
    EXPECT_EQ(results.rows[3].pose, scene::Pose::low);
    // Seen straight down, a flat surface shows every place at its position.
    EXPECT_LT(results.rows[0].error->reprojection_px->distribution.max, 0.01);
    EXPECT_GT(results.rows[3].error->reprojection_px->distribution.rms, 1.0);
}

// From the floor of a bowl, the flat surface at the height of its rim is overhead.
TEST_F(SuiteOnTinyTerrain,
       technique_that_shows_none_of_the_terrain_there_is_has_holes_and_no_zero) {
    Group below = group("ncols 5\nnrows 5\nxllcorner 0\nyllcorner 0\ncellsize 10\n"
                        "9 9 9 9 9\n9 -99 -99 -99 9\n9 -99 -99 -99 9\n9 -99 -99 -99 9\n"
                        "9 9 9 9 9\n",
                        {"texture", "polygons"});
    below.pose = scene::Pose::low;
    const Results results = run_suite({"a suite", {below}}, options(), {});
    ASSERT_FALSE(results.stopped) << results.stopped->message;
    ASSERT_EQ(results.rows.size(), 3U);
    const RowError& texture = *results.rows[0].error;
    EXPECT_FALSE(texture.reprojection_px);
    EXPECT_GT(texture.wrong_percent, 10.0);
    EXPECT_GT(texture.holes, 0U);
    EXPECT_TRUE(results.rows[1].error->reprojection_px);
    for (const Row& row : results.rows) { // no ratio to a picture without terrain
        EXPECT_GT(row.timing.ms.median, 0.0);
        EXPECT_FALSE(row.timing.ratio_to_texture);
    }
    EXPECT_TRUE(results.rows[2].null_row);
    EXPECT_EQ(results.rows[2].setting.technique, "polygons"); // not texture
    EXPECT_EQ(results.rows[2].timing.stats.triangles, 32U);
}

TEST_F(SuiteOnTinyTerrain, under_five_frames_there_is_no_interval_no_floor_and_the_row_is_noisy) {
    auto few = options();
    few.rounds = 4;
    const Group both = group(std::string(test::small_dem), {"texture", "polygons"});
    for (const Row& row : run_suite({"a suite", {both}}, few, {}).rows) {
        EXPECT_FALSE(row.timing.interval);
        EXPECT_FALSE(row.timing.noise_floor);
        EXPECT_TRUE(row.noisy());
    }
    few.rounds = 5;
    for (const Row& row : run_suite({"a suite", {both}}, few, {}).rows) {
        EXPECT_TRUE(row.timing.interval);
        EXPECT_TRUE(row.timing.noise_floor);
    }
}

TEST_F(SuiteOnTinyTerrain, cpu_renderer_tells_no_time_of_a_gpu) {
    const Group one = group(std::string(test::small_dem), {"texture"});
    for (const Row& row : run_suite({"a suite", {one}}, options(), {}).rows) {
        EXPECT_FALSE(row.timing.gpu_ms);
    }
}

TEST_F(SuiteOnTinyTerrain, settings_without_time_are_left_out_counted_and_named) {
    auto hurried = options();
    hurried.rounds = 0;
    hurried.quick = true;
    hurried.quick_seconds = 0.0;
    const Suite suite{"a suite",
                      {group(std::string(test::small_dem),
                             {"texture", "polygons", "relief:n=3,k=1", "relief:n=4,k=1"})}};
    const Results results = run_suite(suite, hurried, {});
    ASSERT_FALSE(results.stopped) << results.stopped->message;
    ASSERT_EQ(results.rows.size(), 2U);
    EXPECT_EQ(results.rows[0].setting.label, "texture");
    EXPECT_TRUE(results.rows[1].null_row);
    ASSERT_EQ(results.left_out.size(), 1U);
    EXPECT_EQ(results.left_out[0].scene, "dem.asc");
    EXPECT_EQ(results.left_out[0].settings, 3U);
    EXPECT_THAT(results.left_out[0].techniques, ElementsAre("polygons", "relief"));
    EXPECT_THAT(results.notes,
                ElementsAre("dem.asc, overview: 3 of 4 settings left out, there was no time for "
                            "them; even the first of polygons, relief"));
    EXPECT_FALSE(results.complete());
    Suite whole = suite;
    whole.may_leave_out = false;
    EXPECT_EQ(run_suite(whole, hurried, {}).rows.size(), 5U);
}

TEST_F(SuiteOnTinyTerrain, stop_while_errors_are_measured_keeps_what_is_done) {
    std::vector<std::string> labels{"texture"};
    for (int n = 1; n <= 30; ++n) {
        labels.push_back("relief:n=" + std::to_string(n) + ",k=1");
    }
    std::stop_source stop;
    int told = 0;
    auto watched = options();
    watched.progress = [&](double /*fraction*/) {
        if (++told == 3) { // three errors are measured
            stop.request_stop();
        }
    };
    const Group group_of_many = group(std::string(test::small_dem), labels);
    const Results results =
        run_suite({"a suite", {group_of_many, group_of_many}}, watched, stop.get_token());
    ASSERT_TRUE(results.stopped);
    ASSERT_EQ(results.rows.size(), 4U);
    EXPECT_EQ(results.rows[2].setting.label, "relief:n=2,k=1");
    EXPECT_TRUE(results.rows[3].null_row);
    for (const Row& row : results.rows) {
        EXPECT_EQ(row.timing.frames, 1U);
        EXPECT_TRUE(row.error);
        EXPECT_TRUE(row.noisy());
    }
    ASSERT_EQ(results.left_out.size(), 1U);
    EXPECT_EQ(results.left_out[0].settings, 28U);
    EXPECT_THAT(results.notes, ElementsAre(HasSubstr("28 of 31 settings left out, as the run was "
                                                     "stopped")));
}

// The terrain is 1 mm by 200 m; the rays of 32 rows miss it by at least two metres.
TEST_F(SuiteOnTinyTerrain, picture_without_a_pixel_of_terrain_is_an_error_and_keeps_earlier_rows) {
    const Group seen = group(std::string(test::small_dem), {"texture"});
    Group unseen = seen;
    unseen.scene.terrain =
        folder_
            .write(
                "thread.asc", "ncols 20001\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize "
                              "0.001\n" +
                                  [] {
                                      std::string rows;
                                      for (int i = 0; i < 2 * 20001; ++i) {
                                          rows += "0 ";
                                      }
                                      return rows;
                                  }())
            .string();
    auto few_rows = options();
    few_rows.size = {64, 32};
    const Results results = run_suite({"a suite", {seen, unseen}}, few_rows, {});
    ASSERT_TRUE(results.stopped);
    EXPECT_THAT(results.stopped->message, HasSubstr("thread.asc, overview: no pixel of terrain"));
    EXPECT_EQ(results.rows.size(), 2U);
}

} // namespace
} // namespace reljef::bench
