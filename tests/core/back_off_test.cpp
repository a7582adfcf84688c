#include "engine/core/back_off.h"

#include <gtest/gtest.h>

namespace reljef {
namespace {

using namespace std::chrono_literals;

TEST(BackOffs, FailuresWithinAPauseAreOne) {
    const auto start = BackOff::Clock::now();
    BackOff back_off(100ms);
    for (const auto after : {0ms, 0ms, 1ms, 50ms, 99ms}) {
        back_off.fail(start + after);
        EXPECT_EQ(back_off.again(), start + 100ms);
        EXPECT_FALSE(back_off.is_given_up(start + after));
    }
}

TEST(BackOffs, PausesGrowUntilItIsGivenUpForHalfAMinute) {
    auto now = BackOff::Clock::now();
    BackOff back_off(100ms);
    for (const auto pause : {100ms, 400ms, 1600ms}) {
        back_off.fail(now);
        EXPECT_FALSE(back_off.is_given_up(now));
        EXPECT_EQ(back_off.again(), now + pause);
        now = back_off.again();
    }
    for (int i = 0; i < 3; ++i) {
        back_off.fail(now);
        EXPECT_TRUE(back_off.is_given_up(now));
        EXPECT_EQ(back_off.again(), now + 30s);
        now = back_off.again();
        EXPECT_FALSE(back_off.is_given_up(now));
    }
}

} // namespace
} // namespace reljef
