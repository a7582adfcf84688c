#include "app/viewer/motion_quality.h"

#include <gtest/gtest.h>

namespace reljef::app {
namespace {

constexpr double smooth = 0.5 * MotionQuality::max_smooth_ms;
constexpr double slow = 2.0 * MotionQuality::max_smooth_ms;

// The quality after two more frames that took so long.
FrameQuality after_two(MotionQuality& tested, double milliseconds) {
    tested.add_frame(milliseconds);
    tested.add_frame(milliseconds);
    return tested.choose(true);
}

TEST(MotionQuality, OneSlowFrameChangesNothing) {
    MotionQuality tested;
    for (const double milliseconds : {smooth, slow, smooth, slow, smooth}) {
        EXPECT_EQ(tested.choose(true), FrameQuality());
        tested.add_frame(milliseconds);
    }
    EXPECT_FALSE(tested.is_reduced());
}

TEST(MotionQuality, AMovingViewIsReducedStepByStepUntilItIsSmooth) {
    MotionQuality tested;
    EXPECT_EQ(after_two(tested, slow), (FrameQuality{1, 1}));
    EXPECT_EQ(after_two(tested, slow), (FrameQuality{1, 2}));
    EXPECT_EQ(after_two(tested, smooth), (FrameQuality{1, 2})) << "it is smooth as it is reduced";
    EXPECT_TRUE(tested.is_reduced());
    EXPECT_EQ(tested.choose(false), FrameQuality()) << "at rest";
    EXPECT_FALSE(tested.is_reduced());
}

TEST(MotionQuality, ThereIsALeastResolution) {
    MotionQuality tested;
    for (int i = 0; i < 20; ++i) {
        after_two(tested, slow);
    }
    EXPECT_EQ(tested.choose(true), (FrameQuality{1, MotionQuality::max_divisor}));
    EXPECT_EQ((FrameQuality{1, 3}.picture_size({1023, 2})), glm::ivec2(341, 1));
}

TEST(MotionQuality, RaysHaveOneSampleWhileTheViewMoves) {
    MotionQuality tested;
    EXPECT_EQ(tested.choose(false, true), FrameQuality());
    EXPECT_FALSE(tested.is_reduced());
    EXPECT_EQ(tested.choose(true, true), (FrameQuality{1, 1}));
    EXPECT_TRUE(tested.is_reduced()) << "it is drawn again at rest";
    EXPECT_EQ(tested.choose(false, true), FrameQuality());
}

TEST(MotionQuality, AStillViewIsDrawnInFullHoweverSlow) {
    MotionQuality tested;
    for (int i = 0; i < 5; ++i) {
        tested.add_frame(slow);
        EXPECT_EQ(tested.choose(false), FrameQuality());
    }
}

} // namespace
} // namespace reljef::app
