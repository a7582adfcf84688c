#include "bench/suites/skip_suite.h"

#include <algorithm>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/report/report_json.h"
#include "bench/report/report_table.h"
#include "bench/suites/skip_kinds.h"
#include "tests/bench/bench_program.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

class SkipSuite : public testing::Test {
protected:
    SkipOptions small_options() {
        SkipOptions options;
        options.terrains = {folder_.write("a.asc", test::small_dem).string()};
        options.poses = {scene::Pose::low};
        options.suite.size = {64, 48};
        options.suite.context = session::BackendKind::osmesa;
        options.suite.rounds = 2;
        options.suite.quiet = true;
        return options;
    }

    test::TemporaryFolder folder_;
};

TEST_F(SkipSuite, leaves_out_each_kind_of_each_test_and_shows_the_same_picture) {
    const Results results = run_skip(small_options(), {});
    ASSERT_FALSE(results.stopped) << results.stopped->message;
    auto row = results.rows.begin();
    for (const SkipTest& test : skip_tests()) {
        if (test.is_streamed) {
            continue;
        }
        const std::size_t first = static_cast<std::size_t>(row - results.rows.begin());
        for (std::size_t i = 0; i < test.kinds.size() + 2; ++i, ++row) {
            ASSERT_NE(row, results.rows.end());
            const bool is_all = i == 0 || i > test.kinds.size();
            EXPECT_EQ(row->test, test.name);
            EXPECT_EQ(row->skip->without, is_all ? "" : test.kinds[i - 1].name);
            EXPECT_EQ(row->null_row, i > test.kinds.size());
            EXPECT_TRUE(row->skip->difference.is_allowed()) << row->setting.label;
            EXPECT_EQ(row->timing.frames, 2U);
            EXPECT_EQ(row->skip->saved.ms.value_or(0.0),
                      i == 0 ? 0.0 : row->timing.ms.median - results.rows[first].timing.ms.median);
            EXPECT_GT(row->work->taps, 0U);
        }
    }
    EXPECT_EQ(row, results.rows.end());
    EXPECT_THAT(results.notes, testing::Contains(testing::HasSubstr("not measured as a stream")));
}

TEST_F(SkipSuite, measures_chosen_kinds_and_rays_alone) {
    SkipOptions options = small_options();
    options.kinds = {"beams"};
    options.suite.context = session::BackendKind::cpu;
    const Results results = run_skip(options, {});
    ASSERT_FALSE(results.stopped) << results.stopped->message;
    ASSERT_EQ(results.rows.size(), 6U); // with and without shadows: all, beams, all again
    for (const Row& row : results.rows) {
        EXPECT_THAT(row.test, testing::HasSubstr("cpu"));
    }
    options.kinds = {"order"};
    EXPECT_TRUE(run_skip(options, {}).failed);
}

TEST_F(SkipSuite, every_kind_has_a_name_of_its_own_in_a_test_and_a_meaning) {
    for (const SkipTest& test : skip_tests()) {
        std::set<std::string_view> names;
        for (const SkipKind& kind : test.kinds) {
            EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
            EXPECT_FALSE(kind.meaning.empty());
        }
    }
}

TEST_F(SkipSuite, tables_say_what_each_kind_saves) {
    SkipOptions options = small_options();
    options.kinds = {"frustum"};
    const Results results = run_skip(options, {});
    const auto tables = report_tables(results);
    ASSERT_FALSE(tables.empty());
    EXPECT_EQ(tables.front().lines.size(), 2U);
    EXPECT_EQ(tables.front().lines[1].front(), "frustum");
    EXPECT_EQ(tables.front().lines[1].back(), "same bits");
    EXPECT_THAT(column_notes(results), testing::Contains("frustum: tiles outside the frustum"));
}

TEST_F(SkipSuite, a_row_with_another_picture_is_an_error) {
    SkipOptions options = small_options();
    options.kinds = {"frustum"};
    Results results = run_skip(options, {});
    EXPECT_TRUE(check_same_pictures(results));
    results.rows[1].skip->difference.pixels = 7;
    results.rows[1].skip->difference.levels = 90;
    const auto checked = check_same_pictures(results);
    ASSERT_FALSE(checked);
    EXPECT_THAT(checked.error().message,
                testing::AllOf(testing::HasSubstr("without frustum"), testing::HasSubstr("7 pix")));
}

TEST_F(SkipSuite, an_unknown_kind_is_a_usage_error) {
    const auto result = test::reljef_bench({"skip", "--kind", "hope"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, testing::HasSubstr("hope"));
}

} // namespace
} // namespace reljef::bench
