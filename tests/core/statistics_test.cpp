#include "engine/core/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
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

TEST(Quantile, lies_between_ranks_on_a_straight_line) {
    const Summary summary = summarize(std::array{10.0, 20.0, 30.0, 40.0, 50.0});
    EXPECT_DOUBLE_EQ(summary.p95, 48.0);
    EXPECT_DOUBLE_EQ(summary.p99, 49.6);
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
        const double share = 0.95;
        const double found = summarize(samples).p95;
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

TEST(MedianInterval, of_one_sample_or_equal_samples_has_no_width) {
    for (const std::vector<double>& samples :
         {std::vector<double>{7.0}, std::vector<double>(31, 7.0)}) {
        const ConfidenceInterval interval = median_interval(samples);
        EXPECT_EQ(interval.low, 7.0);
        EXPECT_EQ(interval.high, 7.0);
    }
}

// A resample of 5 has the smallest as its median where 3 of 5 draws take it: 5.8 % of all, more
// than the tail of 2.5 %. Of 7 the smallest has 1.0 % and the next 10.7 %.
TEST(MedianInterval, of_few_samples_ends_where_counting_says) {
    const ConfidenceInterval of_five = median_interval(std::vector<double>{50, 10, 40, 20, 30});
    EXPECT_EQ(of_five.low, 10.0);
    EXPECT_EQ(of_five.high, 50.0);
    const ConfidenceInterval of_seven =
        median_interval(std::vector<double>{60, 50, 10, 70, 40, 20, 30});
    EXPECT_EQ(of_seven.low, 20.0);
    EXPECT_EQ(of_seven.high, 60.0);
}

// The median of n normal samples strays by 1.2533 σ/√n (asymptotically).
TEST(MedianInterval, of_many_normal_samples_is_as_wide_as_theory_says) {
    std::mt19937 random(3);
    std::normal_distribution<double> values(100.0, 5.0);
    double widths = 0.0;
    for (int i = 0; i < 50; ++i) {
        std::vector<double> samples(400);
        std::generate(samples.begin(), samples.end(), [&] { return values(random); });
        const ConfidenceInterval interval = median_interval(samples, {.resamples = 500});
        widths += (interval.high - interval.low) / 50.0;
    }
    const double theory = 2.0 * 1.96 * 1.2533 * 5.0 / std::sqrt(400.0);
    EXPECT_NEAR(widths, theory, 0.15 * theory);
}

TEST(MedianInterval, holds_the_true_median_as_often_as_it_claims) {
    std::mt19937 random(4);
    std::lognormal_distribution<double> values(0.0, 1.0); // its median is 1
    constexpr int trials = 1000;
    int held = 0;
    for (int i = 0; i < trials; ++i) {
        std::vector<double> samples(40);
        std::generate(samples.begin(), samples.end(), [&] { return values(random); });
        const ConfidenceInterval interval = median_interval(samples, {.resamples = 400});
        held += interval.low <= 1.0 && interval.high >= 1.0 ? 1 : 0;
    }
    EXPECT_GE(held, trials * 92 / 100);
    EXPECT_LE(held, trials * 98 / 100);
}

TEST(MedianInterval, holds_the_median_of_the_samples_and_is_the_same_every_time) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> values(0.01, 100.0);
    for (int i = 0; i < 2000; ++i) {
        std::vector<double> samples(std::uniform_int_distribution<std::size_t>(1, 60)(random));
        std::generate(samples.begin(), samples.end(), [&] { return values(random); });
        const BootstrapOptions options{.resamples = 100};
        const ConfidenceInterval interval = median_interval(samples, options);
        ASSERT_LE(interval.low, median(samples));
        ASSERT_GE(interval.high, median(samples));
        ASSERT_EQ(interval.low, median_interval(samples, options).low);
        ASSERT_EQ(interval.high, median_interval(samples, options).high);
    }
}

TEST(MeanOfLargest, takes_its_share_and_one_at_least) {
    std::vector<double> samples;
    for (int i = 1; i <= 300; ++i) {
        samples.push_back(i);
    }
    std::shuffle(samples.begin(), samples.end(), std::mt19937(6));
    EXPECT_DOUBLE_EQ(mean_of_largest(samples, 0.01), 299.0); // of 298, 299 and 300
    EXPECT_DOUBLE_EQ(mean_of_largest(samples, 0.0), 300.0);
    EXPECT_DOUBLE_EQ(mean_of_largest(samples, 1.0), 150.5);
    EXPECT_DOUBLE_EQ(mean_of_largest(std::span(samples).first(1), 0.01), samples[0]);
    samples.resize(100);
    EXPECT_DOUBLE_EQ(mean_of_largest(samples, 0.29),
                     [&] { // 29 of 100, though 0.29 * 100 is below 29 in binary
                         std::sort(samples.rbegin(), samples.rend());
                         return std::accumulate(samples.begin(), samples.begin() + 29, 0.0) / 29.0;
                     }());
}

TEST(StatisticsDeathTest, of_nothing_is_a_broken_precondition) {
    testing::FLAGS_gtest_death_test_style = "threadsafe";
    EXPECT_DEATH(static_cast<void>(median({})), "no samples");
}

} // namespace
} // namespace reljef
