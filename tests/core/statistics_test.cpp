#include "engine/core/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace reljef {
namespace {

TEST(Median, of_odd_even_and_single_counts) {
    EXPECT_EQ(median(std::array{7.0}), 7.0);
    EXPECT_EQ(median(std::array{9.0, 1.0, 5.0}), 5.0);
    EXPECT_EQ(median(std::array{4.0, 1.0, 3.0, 2.0}), 2.5);
}

TEST(Median, is_not_moved_by_one_slow_frame) {
    EXPECT_EQ(median(std::array{1.0, 2.0, 3.0, 4.0, 1e9}), 3.0);
}

TEST(Quantile, ends_are_the_least_and_the_greatest_sample) {
    constexpr std::array samples{3.0, -1.0, 8.0, 2.0};
    EXPECT_EQ(quantile(samples, 0.0), -1.0);
    EXPECT_EQ(quantile(samples, 1.0), 8.0);
}

TEST(Quantile, lies_between_ranks_on_a_straight_line) {
    constexpr std::array samples{10.0, 20.0, 30.0, 40.0, 50.0};
    EXPECT_DOUBLE_EQ(quantile(samples, 0.25), 20.0);
    EXPECT_DOUBLE_EQ(quantile(samples, 0.95), 48.0);
    EXPECT_DOUBLE_EQ(quantile(samples, 0.99), 49.6);
}

TEST(Summary, of_0_to_100_is_the_percent) {
    std::vector<double> samples;
    for (int i = 100; i >= 0; --i) {
        samples.push_back(i);
    }
    const Summary summary = summarize(samples);
    EXPECT_DOUBLE_EQ(summary.median, 50.0);
    EXPECT_DOUBLE_EQ(summary.p95, 95.0);
    EXPECT_DOUBLE_EQ(summary.p99, 99.0);
}

// Any samples in any order: the share of samples at or below a quantile is the share asked for.
TEST(Quantile, has_its_share_of_the_samples_below_it) {
    std::mt19937 random(1);
    for (int i = 0; i < 5000; ++i) {
        std::vector<double> samples(std::uniform_int_distribution<std::size_t>(1, 60)(random));
        std::lognormal_distribution<double> values(0.0, 2.0);
        std::generate(samples.begin(), samples.end(), [&] { return values(random); });
        const double share = std::uniform_real_distribution<double>(0.0, 1.0)(random);
        const double found = quantile(samples, share);
        const auto below = std::count_if(samples.begin(), samples.end(),
                                         [&](double sample) { return sample <= found; });
        const double steps = share * static_cast<double>(samples.size() - 1);
        ASSERT_GE(static_cast<double>(below), std::floor(steps) + 1.0 - 1e-9);
        ASSERT_LE(static_cast<double>(below), std::ceil(steps) + 1.0 + 1e-9);
    }
}

TEST(Quantile, grows_with_its_share_and_scales_with_the_samples) {
    std::mt19937 random(2);
    for (int i = 0; i < 2000; ++i) {
        std::vector<double> samples(std::uniform_int_distribution<std::size_t>(1, 60)(random));
        std::uniform_real_distribution<double> values(0.01, 100.0);
        std::generate(samples.begin(), samples.end(), [&] { return values(random); });
        const Summary summary = summarize(samples);
        ASSERT_LE(summary.median, summary.p95);
        ASSERT_LE(summary.p95, summary.p99);
        ASSERT_EQ(summary.median, median(samples));
        ASSERT_EQ(summary.p99, quantile(samples, 0.99));
        std::transform(samples.begin(), samples.end(), samples.begin(),
                       [](double sample) { return 4.0 * sample; });
        ASSERT_DOUBLE_EQ(summarize(samples).p95, 4.0 * summary.p95);
    }
}

TEST(RelativeDistance, is_symmetric_and_zero_for_equals) {
    EXPECT_EQ(relative_distance(3.0, 3.0), 0.0);
    EXPECT_DOUBLE_EQ(relative_distance(10.0, 11.0), 0.1);
    EXPECT_DOUBLE_EQ(relative_distance(11.0, 10.0), 0.1);
}

TEST(StatisticsDeathTest, of_nothing_is_a_broken_precondition) {
    testing::FLAGS_gtest_death_test_style = "threadsafe";
    EXPECT_DEATH(static_cast<void>(median({})), "no samples");
}

} // namespace
} // namespace reljef
