#include "app/viewer/sample_choice.h"

#include <gtest/gtest.h>

namespace reljef::app {
namespace {

constexpr double smooth = 0.5 * SampleChoice::max_smooth_ms;
constexpr double slow = 2.0 * SampleChoice::max_smooth_ms;

TEST(SampleChoice, OneSlowFrameChangesNothing) {
    SampleChoice tested;
    for (const double milliseconds : {smooth, slow, smooth, slow, smooth}) {
        EXPECT_EQ(tested.choose(true), render::automatic_samples);
        tested.add_frame(milliseconds);
    }
    EXPECT_FALSE(tested.is_reduced());
}

TEST(SampleChoice, AMovingViewThatStaysSlowHasOneSampleUntilItRests) {
    SampleChoice tested;
    tested.add_frame(slow);
    tested.add_frame(slow);
    EXPECT_EQ(tested.choose(true), 1);
    tested.add_frame(smooth);
    tested.add_frame(smooth);
    EXPECT_EQ(tested.choose(true), 1) << "it is smooth as it has one sample";
    EXPECT_TRUE(tested.is_reduced());
    EXPECT_EQ(tested.choose(false), render::automatic_samples);
    EXPECT_FALSE(tested.is_reduced());
}

TEST(SampleChoice, AStillViewKeepsItsSamplesHoweverSlow) {
    SampleChoice tested;
    for (int i = 0; i < 5; ++i) {
        tested.add_frame(slow);
        EXPECT_EQ(tested.choose(false), render::automatic_samples);
    }
}

} // namespace
} // namespace reljef::app
