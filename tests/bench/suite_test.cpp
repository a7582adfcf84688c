#include "bench/suite.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/bench/bench_program.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Candidate, of_the_catalogue_has_every_parameter_in_its_label) {
    const Candidate candidate = candidate_named("polygons");
    ASSERT_TRUE(candidate.technique);
    EXPECT_EQ(candidate.setting.technique, "polygons");
    EXPECT_EQ(candidate.setting.label, scene::to_string(*candidate.technique));
    EXPECT_EQ(candidate.setting.parameters.front().name, "lods");
}

TEST(Candidate, that_does_not_exist_keeps_its_names_and_numbers) {
    const Candidate none = candidate_named("magic");
    EXPECT_FALSE(none.technique);
    EXPECT_EQ(none.setting.label, "magic");
    EXPECT_TRUE(none.setting.parameters.empty());
    const Candidate refused = candidate_named("polygons:lods=1000000,depth=0.5,x");
    EXPECT_FALSE(refused.technique);
    EXPECT_EQ(refused.setting.technique, "polygons");
    EXPECT_EQ(refused.setting.label, "polygons:lods=1000000,depth=0.5,x");
    EXPECT_THAT(refused.setting.parameters,
                ElementsAre(Setting::Parameter{"lods", 1e6}, Setting::Parameter{"depth", 0.5}));
}

class SuiteOnTinyTerrain : public testing::Test {
protected:
    SuiteOptions options() {
        SuiteOptions options;
        options.size = {64, 48};
        options.context = platform::ContextKind::osmesa;
        options.rounds = 3;
        options.quiet = true;
        return options;
    }

    Group group(const std::string& dem, std::vector<std::string> techniques) {
        Group group{"a test", {folder_.write("dem.asc", dem).string()}, scene::Pose::overview, {}};
        for (const std::string& technique : techniques) {
            group.candidates.push_back(candidate_named(technique));
        }
        return group;
    }

    test::TemporaryFolder folder_;
};

TEST_F(SuiteOnTinyTerrain, missing_technique_is_a_row_without_figures) {
    Group with_missing = group(std::string(test::small_dem), {"texture", "magic", "polygons"});
    with_missing.candidates[1].source = SourceFigure{50.0, 2.0, "somewhere"};
    const Results results = run_suite({"a suite", {with_missing}}, options(), {});
    ASSERT_FALSE(results.stopped) << results.stopped->message;
    ASSERT_EQ(results.rows.size(), 4U);
    EXPECT_TRUE(results.rows[1].missing());
    EXPECT_FALSE(results.rows[1].error);
    EXPECT_EQ(results.rows[1].source->fps, 50.0);
    EXPECT_EQ(results.rows[1].test, "a test");
    EXPECT_EQ(results.rows[2].setting.technique, "polygons");
    EXPECT_EQ(results.rows[2].timing->stats.triangles, 8U); // its own, not the next one's
    EXPECT_TRUE(results.rows[3].null_row);
    EXPECT_EQ(results.rows[3].timing->stats.triangles, 2U);
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
    // Straight down, flat or not, every place is where it is.
    EXPECT_LT(results.rows[0].error->reprojection_px->distribution.max, 0.01);
    EXPECT_GT(results.rows[3].error->reprojection_px->distribution.rms, 1.0);
}

// Seen from its own valley floor, a bowl's flat surface, at its rim or above, is overhead.
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
}

// The terrain is a thread of 1 mm by 200 m; the rays of 32 rows pass it by two metres and more.
TEST_F(SuiteOnTinyTerrain, picture_without_a_pixel_of_terrain_is_an_error_and_keeps_earlier_rows) {
    const Group seen = group(std::string(test::small_dem), {"texture"});
    Group unseen = seen;
    unseen.stage.terrain =
        folder_
            .write(
                "thread.asc", "ncols 200001\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize "
                              "0.001\n" +
                                  [] {
                                      std::string rows;
                                      for (int i = 0; i < 2 * 200001; ++i) {
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
