#include "app/viewer/appearance/contour_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/viewer/viewer_content.h"
#include "tests/app/effects/keyed_viewer.h"

namespace reljef::app {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

TEST(ContourWatch, NotesAFadedIntervalOnceAndKeepsItsSentenceWhileItHolds) {
    KeyedViewer tested;
    const auto sentence = [&] {
        return content_of(tested.viewer, tested.scene, keyed_window).appearance.faded_contours;
    };
    const auto rest = [&] {
        tested.settle();
        tested.settle();
    };
    rest();
    EXPECT_THAT(sentence(), IsEmpty());
    tested.notes();
    ASSERT_TRUE(tested.viewer.act(SetContours{0.01}));
    tested.settle();
    EXPECT_THAT(sentence(), IsEmpty()) << "it does not rest yet";
    rest();
    EXPECT_THAT(sentence(), HasSubstr("contours every 0.01 m are too close"));
    EXPECT_TRUE(tested.viewer.take_content_change());
    EXPECT_EQ(tested.notes(), sentence() + '\n');
    tested.press(Key::o);
    rest();
    EXPECT_THAT(sentence(), HasSubstr("closer map"));
    EXPECT_THAT(tested.notes(), IsEmpty()) << "once for each interval";
    ASSERT_TRUE(tested.viewer.act(SetContours{20.0}));
    rest();
    EXPECT_THAT(sentence(), IsEmpty());
    EXPECT_TRUE(tested.viewer.take_content_change());
    ASSERT_TRUE(tested.viewer.act(SetContours{0.01}));
    tested.press(Key::f);
    rest();
    EXPECT_THAT(sentence(), IsEmpty()) << "edges of triangles have no contours";
}

// `render` refuses other intervals.
TEST(Contours, AreNoFartherApartAndNoCloserThanPicturesHaveThem) {
    KeyedViewer tested;
    const auto shown = [&](double metres) {
        tested.notes();
        EXPECT_TRUE(tested.viewer.act(SetContours{metres}));
        return tested.scene.terrain->get<scene::TerrainNode>()->contours;
    };
    EXPECT_EQ(shown(scene::max_contours), scene::max_contours);
    EXPECT_THAT(tested.notes(), IsEmpty());
    EXPECT_EQ(shown(2.5e6), scene::max_contours);
    EXPECT_THAT(tested.notes(),
                HasSubstr("contours every 2500000 m found, 0 (none) or 0.001 to 1000000 m"));
    EXPECT_EQ(shown(1e-5), scene::min_contours);
    EXPECT_THAT(tested.notes(), HasSubstr("they are every 0.001 m"));
    EXPECT_EQ(shown(0.0), 0.0);
    EXPECT_THAT(tested.notes(), IsEmpty());
}

} // namespace
} // namespace reljef::app
