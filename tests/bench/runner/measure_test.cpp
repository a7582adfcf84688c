#include "bench/runner/measure.h"

#include <chrono>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace reljef::bench {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

// Frames that record their order and take a known time of a simulated clock.
class Measuring : public testing::Test {
protected:
    DrawFrame thing(char name, double takes_ms) {
        return [this, name, takes_ms]() -> Result<void> {
            order_ += name;
            now_ms_ += takes_ms;
            return {};
        };
    }

    MeasureOptions rounds(int count) {
        MeasureOptions options;
        options.warm_up_rounds = 0;
        options.min_rounds = count;
        options.max_rounds = count;
        options.seconds = 0.0;
        options.now_ms = [this] { return now_ms_; };
        return options;
    }

    std::string order_;
    double now_ms_ = 1e6;
};

TEST_F(Measuring, goes_in_turn_and_not_one_after_the_other) {
    const std::vector<DrawFrame> things{thing('A', 1.0), thing('B', 2.0), thing('C', 4.0)};
    const auto measured = measure(things, rounds(3));
    ASSERT_TRUE(measured);
    EXPECT_EQ(order_, "ABCABCABC");
    EXPECT_THAT(measured->ms, ElementsAre(ElementsAre(1.0, 1.0, 1.0), ElementsAre(2.0, 2.0, 2.0),
                                          ElementsAre(4.0, 4.0, 4.0)));
    EXPECT_FALSE(measured->stopped);
}

TEST_F(Measuring, warm_up_is_drawn_and_not_timed) {
    int drawn = 0;
    const std::vector<DrawFrame> things{[&]() -> Result<void> {
        now_ms_ += ++drawn <= 2 ? 500.0 : 3.0; // the first frames compile and upload
        return {};
    }};
    auto options = rounds(4);
    options.warm_up_rounds = 2;
    const auto measured = measure(things, options);
    ASSERT_TRUE(measured);
    EXPECT_EQ(drawn, 6);
    EXPECT_THAT(measured->ms, ElementsAre(ElementsAre(3.0, 3.0, 3.0, 3.0)));
}

TEST_F(Measuring, goes_on_until_the_time_is_over) {
    const std::vector<DrawFrame> things{thing('A', 60.0), thing('B', 40.0)};
    auto options = rounds(5);
    options.max_rounds = 1000;
    options.seconds = 2.0;
    const auto measured = measure(things, options);
    ASSERT_TRUE(measured);
    EXPECT_THAT(measured->ms, Each(SizeIs(20)));
}

TEST_F(Measuring, slow_frames_get_the_least_rounds_all_the_same) {
    const std::vector<DrawFrame> things{thing('A', 60'000.0), thing('B', 40'000.0)};
    auto options = rounds(5);
    options.max_rounds = 1000;
    options.seconds = 2.0;
    const auto measured = measure(things, options);
    ASSERT_TRUE(measured);
    EXPECT_THAT(measured->ms, Each(SizeIs(5)));
}

TEST_F(Measuring, fast_frames_end_at_the_most_rounds) {
    const std::vector<DrawFrame> things{thing('A', 0.001)};
    auto options = rounds(5);
    options.max_rounds = 70;
    options.seconds = 100.0;
    const auto measured = measure(things, options);
    ASSERT_TRUE(measured);
    EXPECT_THAT(measured->ms, Each(SizeIs(70)));
}

TEST_F(Measuring, last_limit_holds_even_for_slow_frames) {
    const std::vector<DrawFrame> things{thing('A', 3000.0), thing('B', 1000.0)};
    auto options = rounds(5);
    options.warm_up_rounds = 1;
    options.max_seconds = 15.0; // the warm-up and two rounds take 12, one more would end at 16
    const auto measured = measure(things, options);
    ASSERT_TRUE(measured);
    EXPECT_THAT(measured->ms, Each(SizeIs(2)));
}

TEST_F(Measuring, there_is_one_round_even_beyond_the_last_limit) {
    const std::vector<DrawFrame> things{thing('A', 3000.0), thing('B', 1000.0)};
    for (const double limit : {0.1, -1.0}) {
        auto options = rounds(5);
        options.warm_up_rounds = 1;
        options.max_seconds = limit;
        const auto measured = measure(things, options);
        ASSERT_TRUE(measured);
        EXPECT_THAT(measured->ms, Each(SizeIs(1)));
    }
}

TEST_F(Measuring, progress_tells_the_time_left_from_the_first_frame_on) {
    const std::vector<DrawFrame> things{thing('A', 100.0), thing('B', 100.0)};
    auto options = rounds(8);
    options.warm_up_rounds = 2;
    std::vector<double> told;
    options.progress = [&](double fraction) { told.push_back(fraction); };
    ASSERT_TRUE(measure(things, options));
    ASSERT_THAT(told, SizeIs(20));
    for (std::size_t i = 0; i < told.size(); ++i) {
        EXPECT_NEAR(told[i], static_cast<double>(i + 1) / 20.0, 1e-9);
    }
}

TEST_F(Measuring, progress_rises_to_one) {
    const std::vector<DrawFrame> things{thing('A', 60.0), thing('B', 40.0)};
    for (const double seconds : {0.0, 0.2, 2.0}) {
        auto options = rounds(5);
        options.max_rounds = 12;
        options.seconds = seconds;
        double last = 0.0;
        options.progress = [&](double fraction) {
            EXPECT_GE(fraction, last);
            last = fraction;
        };
        ASSERT_TRUE(measure(things, options));
        EXPECT_DOUBLE_EQ(last, 1.0) << seconds;
    }
}

// Two equal frames; the second takes `times` as long as the first until `quiet_at_ms`.
class MeasuringNoise : public Measuring {
protected:
    std::vector<DrawFrame> pair(double times, double quiet_at_ms) {
        return {thing('A', 100.0), thing('B', 50.0), [=, this]() -> Result<void> {
                    now_ms_ += now_ms_ < 1e6 + quiet_at_ms ? times * 100.0 : 100.0;
                    return {};
                }};
    }

    MeasureOptions noisy_options() {
        auto options = rounds(5);
        options.max_rounds = 1000;
        options.seconds = 2.0;
        options.null_pair = {0, 2};
        options.noisy_seconds = 20.0;
        return options;
    }
};

TEST_F(MeasuringNoise, floor_is_how_far_the_pair_lies_apart) {
    const auto measured = measure(pair(1.05, 1e9), noisy_options());
    ASSERT_TRUE(measured);
    EXPECT_NEAR(*measured->noise_floor, 0.05, 1e-9);
    EXPECT_THAT(measured->ms, Each(SizeIs(8))); // of 255 ms each: no more than without noise
}

TEST_F(MeasuringNoise, noisy_pair_is_measured_until_it_is_quiet) {
    const auto measured = measure(pair(1.5, 3000.0), noisy_options());
    ASSERT_TRUE(measured);
    EXPECT_LE(*measured->noise_floor, 0.10);
    EXPECT_GT(measured->ms[0].size(), 20U); // the quiet half of them
    EXPECT_LT(measured->ms[0].size(), 35U);
}

TEST_F(MeasuringNoise, pair_that_stays_noisy_ends_at_the_limit_and_keeps_its_floor) {
    const auto measured = measure(pair(1.5, 1e9), noisy_options());
    ASSERT_TRUE(measured);
    EXPECT_NEAR(*measured->noise_floor, 0.5, 1e-9);
    EXPECT_THAT(measured->ms, Each(SizeIs(67))); // 300 ms each, none begins after 20 s
}

TEST_F(MeasuringNoise, rounds_that_were_asked_for_stay_as_many) {
    auto options = noisy_options();
    options.max_rounds = options.min_rounds;
    const auto measured = measure(pair(1.5, 1e9), options);
    ASSERT_TRUE(measured);
    EXPECT_THAT(measured->ms, Each(SizeIs(5)));
}

TEST_F(MeasuringNoise, last_limit_holds_for_noise_too) {
    auto options = noisy_options();
    options.max_seconds = 4.0;
    const auto measured = measure(pair(1.5, 1e9), options);
    ASSERT_TRUE(measured);
    EXPECT_THAT(measured->ms, Each(SizeIs(13))); // one more would end at 4.2 s
}

TEST_F(Measuring, without_a_pair_or_its_times_there_is_no_floor) {
    std::stop_source stop;
    const std::vector<DrawFrame> things{[&]() -> Result<void> {
                                            stop.request_stop();
                                            return {};
                                        },
                                        thing('B', 1.0)};
    auto options = rounds(5);
    options.null_pair = {0, 1};
    options.stop = stop.get_token();
    const auto stopped = measure(things, options);
    ASSERT_TRUE(stopped);
    EXPECT_FALSE(stopped->noise_floor);
    const auto alone = measure(std::vector<DrawFrame>{thing('A', 1.0)}, rounds(5));
    ASSERT_TRUE(alone);
    EXPECT_FALSE(alone->noise_floor);
}

TEST_F(Measuring, stop_ends_after_the_frame_and_keeps_what_was_timed) {
    std::stop_source stop;
    const std::vector<DrawFrame> things{thing('A', 1.0),
                                        [&]() -> Result<void> {
                                            order_ += 'B';
                                            if (order_.size() == 5) {
                                                stop.request_stop();
                                            }
                                            return {};
                                        },
                                        thing('C', 4.0)};
    auto options = rounds(100);
    options.stop = stop.get_token();
    const auto measured = measure(things, options);
    ASSERT_TRUE(measured);
    EXPECT_TRUE(measured->stopped);
    EXPECT_EQ(order_, "ABCAB");
    EXPECT_THAT(measured->ms, ElementsAre(SizeIs(2), SizeIs(2), SizeIs(1)));
}

TEST_F(Measuring, stop_before_the_first_frame_draws_nothing) {
    std::stop_source stop;
    stop.request_stop();
    const std::vector<DrawFrame> things{thing('A', 1.0), thing('B', 1.0)};
    auto options = rounds(5);
    options.warm_up_rounds = 2;
    options.stop = stop.get_token();
    const auto measured = measure(things, options);
    ASSERT_TRUE(measured);
    EXPECT_EQ(order_, "");
    EXPECT_THAT(measured->ms, ElementsAre(IsEmpty(), IsEmpty()));
}

TEST_F(Measuring, frame_that_fails_is_told_in_its_words) {
    for (const int warm_up_rounds : {0, 1}) {
        order_.clear();
        const std::vector<DrawFrame> things{
            thing('A', 1.0), []() -> Result<void> { return Error{"the card caught fire"}; },
            thing('C', 1.0)};
        auto options = rounds(5);
        options.warm_up_rounds = warm_up_rounds;
        const auto measured = measure(things, options);
        ASSERT_FALSE(measured);
        EXPECT_EQ(measured.error().message, "the card caught fire");
        EXPECT_EQ(order_, "A");
    }
}

TEST(MeasuringByTheSystemClock, is_in_milliseconds) {
    using Clock = std::chrono::steady_clock;
    const std::vector<DrawFrame> things{[]() -> Result<void> {
        const auto end = Clock::now() + std::chrono::milliseconds(3);
        while (Clock::now() < end) {
        }
        return {};
    }};
    MeasureOptions options;
    options.max_rounds = options.min_rounds;
    const auto measured = measure(things, options);
    ASSERT_TRUE(measured);
    EXPECT_THAT(measured->ms.front(), Each(testing::Ge(3.0)));
    EXPECT_THAT(measured->ms.front(), testing::Contains(testing::Le(300.0)));
}

} // namespace
} // namespace reljef::bench
