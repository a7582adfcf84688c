#include "app/viewer/timing/frame_timer.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/viewer/timing/program_age.h"
#include "app/viewer/timing/recent_times.h"

namespace reljef::app {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr OpenWork idle{};
const Event key_press = KeyEvent{.key = Key::f, .pressed = true};

// A clock that the test moves; waiting for the GPU takes 3 ms.
struct FrameTimerTest : testing::Test {
    std::vector<double> ms_of(std::string_view key) {
        for (const TimeRow& row : timer.times().report().rows) {
            if (row.key == key) {
                return row.ms;
            }
        }
        ADD_FAILURE() << key;
        return {};
    }
    void draw_panels(PanelWork work, double seconds) {
        FrameTimer::PanelScope timed(timer);
        timed.set(work);
        now += seconds;
    }

    double now = 5.0;
    FrameTimer timer{{[this] { return now; }, [this] { now += 0.003; }}};
};

TEST_F(FrameTimerTest, PanelsOfAFrameAreAddedWithTheirDrawing) {
    draw_panels(PanelWork::drawn, 0.001);
    draw_panels(PanelWork::copied, 0.001);
    timer.show(idle, 8.0, 12.0);
    draw_panels(PanelWork::copied, 0.0);
    timer.show(idle, 8.0, 12.0);
    EXPECT_THAT(ms_of("panels_drawn"), ElementsAre(DoubleNear(8.0, 1e-6)));
    EXPECT_THAT(ms_of("panels_copied"), ElementsAre(DoubleNear(3.0, 1e-6)));
}

TEST_F(FrameTimerTest, HiddenPanelsAreNotWaitedFor) {
    { const FrameTimer::PanelScope hidden(timer); }
    timer.show(idle, 8.0, 12.0);
    EXPECT_THAT(ms_of("panels_hidden"), ElementsAre(0.0));
    EXPECT_THAT(ms_of("frames_without_panels"), ElementsAre(12.0));
}

TEST_F(FrameTimerTest, OnlyPressesClicksAndWheelAskForAnAnswer) {
    EXPECT_TRUE(asks_for_answer(key_press));
    EXPECT_TRUE(asks_for_answer(MouseButtonEvent{.pressed = true}));
    EXPECT_TRUE(asks_for_answer(MouseButtonEvent{.pressed = false})) << "buttons act then";
    EXPECT_TRUE(asks_for_answer(ScrollEvent{}));
    for (const Event& event :
         {Event(KeyEvent{.key = Key::f}), Event(KeyEvent{.pressed = true, .repeat = true}),
          Event(MouseMoveEvent{}), Event(ResizeEvent{}), Event(FocusEvent{}), Event(TextEvent{})}) {
        EXPECT_FALSE(asks_for_answer(event));
    }
}

TEST_F(FrameTimerTest, ARoundWithoutAFrameEndsWhatWaits) {
    timer.receive(key_press, idle);
    timer.end_round({.is_stale = true}); // the panels will show it
    now += 0.02;
    timer.show(idle);
    timer.end_round(idle);
    EXPECT_THAT(ms_of("keys"), ElementsAre(DoubleNear(20.0, 1e-6)));
    timer.receive(key_press, idle);
    timer.end_round(idle);
    timer.show(idle);
    EXPECT_EQ(ms_of("keys").size(), 1U);
}

TEST_F(FrameTimerTest, ActionsMakeAnswersThoseOfControls) {
    timer.receive(key_press, idle);
    timer.act(0);
    timer.show(idle, 8.0, 12.0);
    timer.receive(key_press, idle);
    timer.act(2);
    timer.show(idle, 8.0, 12.0);
    EXPECT_EQ(ms_of("keys").size(), 1U);
    EXPECT_EQ(ms_of("controls").size(), 1U);
}

TEST(FrameTimer, DoesNothingWithoutASource) {
    FrameTimer timer;
    timer.receive(key_press, idle);
    {
        FrameTimer::PanelScope timed(timer);
        timed.set(PanelWork::drawn);
    }
    timer.act(1);
    timer.show(idle, 1.0, 2.0);
    timer.end_round(idle);
    EXPECT_FALSE(timer.times().report().first_picture);
    EXPECT_THAT(timer.times().report().rows.front().ms, IsEmpty());
}

TEST(RecentTimes, KeepTheLastFrames) {
    RecentTimes recent;
    for (std::size_t i = 0; i < RecentTimes::max_frames + 3; ++i) {
        recent.add(static_cast<double>(i));
    }
    EXPECT_EQ(recent.all().size(), RecentTimes::max_frames);
    EXPECT_EQ(recent.all().front(), 3.0F);
    EXPECT_EQ(recent.all().back(), static_cast<float>(RecentTimes::max_frames + 2));
}

// The test's own program: it began before now, and time goes on.
TEST(ProgramAge, GrowsFromTheBeginningOfTheProcess) {
    const auto first = program_age();
    ASSERT_TRUE(first) << first.error().message;
    EXPECT_GE(*first, -0.01); // the system counts hundredths
    const auto second = program_age();
    ASSERT_TRUE(second);
    EXPECT_GE(*second, *first);
    EXPECT_LT(*first, 24.0 * 3600.0) << "of the process, not of the system";
}

} // namespace
} // namespace reljef::app
