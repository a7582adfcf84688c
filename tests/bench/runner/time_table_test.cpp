#include "bench/runner/time_table.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "bench/report/results.h"

namespace reljef::bench {
namespace {

SuiteOptions quick_options() {
    SuiteOptions options;
    options.quick = true;
    return options;
}

TEST(TimeTable, shares_what_is_left_evenly_and_never_less_than_none) {
    const SuiteOptions quick = quick_options();
    EXPECT_DOUBLE_EQ(group_seconds(quick, 0.0, 8), quick.quick_seconds / 8.0);
    EXPECT_DOUBLE_EQ(group_seconds(quick, 40.0, 2), (quick.quick_seconds - 40.0) / 2.0);
    EXPECT_EQ(group_seconds(quick, 1000.0, 1), 0.0);
}

TEST(TimeTable, page_is_written_in_the_same_minute) {
    SuiteOptions with_page = quick_options();
    with_page.keep_views = true;
    EXPECT_DOUBLE_EQ(group_seconds(with_page, 0.0, 1), with_page.quick_seconds - page_seconds);
}

TEST(TimeTable, only_quick_runs_that_are_not_told_their_rounds_are_bounded) {
    EXPECT_TRUE(std::isinf(group_seconds({}, 1000.0, 1)));
    SuiteOptions rounds = quick_options();
    rounds.rounds = 3;
    EXPECT_TRUE(std::isinf(group_seconds(rounds, 1000.0, 1)));
    EXPECT_TRUE(std::isinf(measuring(rounds, 1, 0.0).max_seconds));
    EXPECT_EQ(measuring(rounds, 1, 0.0).min_rounds, 3);
    EXPECT_EQ(measuring(rounds, 1, 0.0).max_rounds, 3);
}

// If each group keeps to its share, the run ends within a minute.
TEST(TimeTable, groups_that_keep_to_their_share_end_in_time) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    const SuiteOptions quick = quick_options();
    for (int i = 0; i < 3000; ++i) {
        double elapsed = 5.0 * share(random);
        for (std::size_t left = 1 + random() % 12; left > 0; --left) {
            elapsed += share(random) * group_seconds(quick, elapsed, left);
        }
        ASSERT_LE(elapsed, quick.quick_seconds + 1e-9);
    }
}

TEST(TimeTable, candidate_more_costs_what_those_before_it_did) {
    const GroupCost cost{
        .elapsed = 3.0, .error_seconds = 0.8, .checked = 4, .round = 0.6, .frames = 6};
    const GroupCost more = with_another(cost);
    EXPECT_DOUBLE_EQ(more.elapsed, 3.2);
    EXPECT_DOUBLE_EQ(more.error_seconds, 1.0);
    EXPECT_EQ(more.checked, 5);
    EXPECT_DOUBLE_EQ(more.round, 0.7);
    EXPECT_EQ(more.frames, 7);
    EXPECT_DOUBLE_EQ(with_another(cost, 2.0).round, 2.6);
    EXPECT_EQ(with_another({}).round, 0.0);
}

TEST(TimeTable, group_fits_if_all_its_candidates_can_be_drawn_often_enough) {
    const GroupCost cost{
        .elapsed = 2.0, .error_seconds = 1.0, .checked = 1, .round = 0.5, .frames = 2};
    const double needed = 2.0 + 0.5 * static_cast<double>(min_frames);
    EXPECT_TRUE(fits(cost, needed));
    EXPECT_FALSE(fits(cost, needed - 0.01));
    EXPECT_TRUE(fits(cost, std::numeric_limits<double>::infinity()));
}

// Adds candidates one by one, as the suite does.
TEST(TimeTable, candidates_that_were_let_in_fit_into_the_groups_time) {
    std::mt19937 random(2);
    std::lognormal_distribution<double> seconds(-3.0, 1.0);
    for (int i = 0; i < 2000; ++i) {
        const double share = 10.0 * seconds(random);
        GroupCost cost;
        for (int candidate = 0; candidate < 40; ++candidate) {
            const double frame = seconds(random);
            const GroupCost next = with_another(cost, frame);
            cost = fits(next, share) ? next : cost;
        }
        ASSERT_TRUE(cost.frames == 0 || fits(cost, share));
    }
}

TEST(TimeTable, quick_groups_are_timed_for_ten_seconds_together) {
    const SuiteOptions quick = quick_options();
    EXPECT_DOUBLE_EQ(8.0 * measuring(quick, 8, 3.0).seconds, 10.0);
    EXPECT_EQ(measuring(quick, 8, 3.0).max_seconds, 3.0);
    EXPECT_GT(measuring({}, 8, 3.0).seconds, measuring(quick, 8, 3.0).seconds);
    EXPECT_TRUE(std::isinf(measuring({}, 8, 3.0).max_seconds));
}

} // namespace
} // namespace reljef::bench
