#include "app/viewer/timing/viewer_times.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace reljef::app {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr OpenWork no_work{};
constexpr OpenWork preparing{.is_preparing = true};
constexpr OpenWork loading{.is_loading = true};
constexpr OpenWork acting{.has_actions = true};

ShownFrame picture_at(double seconds, PanelWork panels = PanelWork::copied,
                      double panels_ms = 0.5) {
    return {.at = seconds,
            .picture_ms = 8.0,
            .frame_ms = 10.0,
            .panels_ms = panels_ms,
            .panels = panels};
}

ShownFrame panels_at(double seconds) {
    return {.at = seconds, .panels_ms = 2.0, .panels = PanelWork::drawn};
}

TimeRow row_of(const ViewerTimes& times, std::string_view key) {
    const auto rows = times.report().rows;
    const auto found =
        std::find_if(rows.begin(), rows.end(), [&](const TimeRow& row) { return row.key == key; });
    EXPECT_NE(found, rows.end()) << key;
    return found != rows.end() ? *found : TimeRow{};
}

TEST(ViewerTimes, KnowsTheFirstPictureAndTheFirstCompleteOne) {
    ViewerTimes times;
    EXPECT_FALSE(times.report().first_picture);
    times.show(panels_at(0.1), no_work);
    EXPECT_FALSE(times.report().first_picture) << "panels are no picture";
    times.show(picture_at(0.3), preparing);
    times.show(picture_at(0.5), loading);
    times.show(picture_at(0.7), acting);
    EXPECT_EQ(times.report().first_picture, 0.3);
    EXPECT_FALSE(times.report().complete_picture);
    times.show(picture_at(0.9), no_work);
    times.show(picture_at(1.1), no_work);
    EXPECT_EQ(times.report().first_picture, 0.3);
    EXPECT_EQ(times.report().complete_picture, 0.9);
}

TEST(ViewerTimes, TellFramesAndPanelsApart) {
    ViewerTimes times;
    times.show(picture_at(1.0, PanelWork::drawn, 1.5), no_work);
    times.show(picture_at(2.0, PanelWork::copied, 0.25), no_work);
    times.show(picture_at(3.0, PanelWork::hidden, 0.0), no_work);
    times.show(panels_at(4.0), no_work);
    EXPECT_THAT(row_of(times, "frames_with_panels").ms, ElementsAre(10.0, 10.0));
    EXPECT_THAT(row_of(times, "frames_without_panels").ms, ElementsAre(10.0));
    EXPECT_THAT(row_of(times, "panels").ms, ElementsAre(1.5, 0.25, 2.0));
    EXPECT_THAT(row_of(times, "panels_drawn").ms, ElementsAre(1.5, 2.0));
    EXPECT_THAT(row_of(times, "panels_copied").ms, ElementsAre(0.25));
    EXPECT_THAT(row_of(times, "panels_hidden").ms, ElementsAre(0.0));
}

TEST(ViewerTimes, AKeyIsAnsweredByTheNextFrame) {
    ViewerTimes times;
    times.receive(1.0, no_work);
    times.receive(1.01, no_work);
    times.show(picture_at(1.02), no_work);
    times.show(picture_at(1.04), no_work);
    const TimeRow keys = row_of(times, "keys");
    EXPECT_THAT(keys.ms, ElementsAre(DoubleNear(20.0, 1e-9), DoubleNear(10.0, 1e-9)));
    EXPECT_EQ(keys.max_frames, 1);
    EXPECT_THAT(row_of(times, "controls").ms, IsEmpty());
}

TEST(ViewerTimes, AControlIsAnsweredWhenItsActionIsShown) {
    ViewerTimes times;
    times.receive(1.0, loading);
    times.show(panels_at(1.01), acting); // the panel shows the click, the scene does not yet
    EXPECT_THAT(row_of(times, "keys").ms, IsEmpty());
    times.act();
    times.show(picture_at(1.03), loading);
    const TimeRow controls = row_of(times, "controls");
    EXPECT_THAT(controls.ms, ElementsAre(DoubleNear(30.0, 1e-9)));
    EXPECT_EQ(controls.max_frames, 2);
    EXPECT_THAT(row_of(times, "controls_while_loading").ms, ElementsAre(DoubleNear(30.0, 1e-9)));
    EXPECT_THAT(row_of(times, "keys").ms, IsEmpty());
}

TEST(ViewerTimes, AHeldSliderHasItsAnswerThoughItActsAgain) {
    ViewerTimes times;
    times.receive(1.0, no_work);
    times.act();
    times.show(picture_at(1.02), acting);
    EXPECT_EQ(row_of(times, "controls").max_frames, 1);
}

TEST(ViewerTimes, AnAnswerThatIsPreparedIsOfAKindOfItsOwn) {
    ViewerTimes times;
    times.receive(1.0, no_work);
    times.act();
    times.show(picture_at(1.02), preparing);
    times.show(picture_at(1.5), preparing);
    times.show(picture_at(2.0), no_work);
    EXPECT_THAT(row_of(times, "controls").ms, IsEmpty());
    EXPECT_THAT(row_of(times, "prepared").ms, ElementsAre(DoubleNear(1000.0, 1e-9)));
    EXPECT_EQ(row_of(times, "prepared").max_frames, 3);
}

// What was prepared before is for another event.
TEST(ViewerTimes, EarlierPreparationKeepsNoAnswerBack) {
    ViewerTimes times;
    times.receive(1.0, preparing);
    times.show(picture_at(1.02), preparing);
    EXPECT_THAT(row_of(times, "keys").ms, ElementsAre(DoubleNear(20.0, 1e-9)));
    EXPECT_THAT(row_of(times, "prepared").ms, IsEmpty());
}

TEST(ViewerTimes, EventsThatChangeNothingHaveNoAnswer) {
    ViewerTimes times;
    times.receive(1.0, no_work);
    times.rest();
    times.show(picture_at(9.0), no_work);
    EXPECT_THAT(row_of(times, "keys").ms, IsEmpty());
    EXPECT_FALSE(row_of(times, "keys").max_frames);
}

} // namespace
} // namespace reljef::app
