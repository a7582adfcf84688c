#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/truth/image_error.h"
#include "tests/cast/frame/compared_pictures.h"
#include "tests/cast/frame/overlay_stage.h"
#include "tests/gl/gl_fixture.h"

namespace reljef::cast {
namespace {

// How much darker each column of the middle row is than without contours, [0, 1].
std::vector<double> ink_of(OverlayStage& stage, double interval) {
    stage.node().contours = 0.0;
    const Image plain = stage.drawn();
    stage.node().contours = interval;
    const Image lined = stage.drawn();
    std::vector<double> ink;
    for (int col = 0; col < overlay_picture.x; ++col) {
        const auto linear = [&](const Image& image) {
            return static_cast<double>(linear_from_rgba8(image(col, overlay_picture.y / 2)).g);
        };
        ink.push_back(1.0 - linear(lined) / linear(plain));
    }
    return ink;
}

class ContoursGlTest : public test::GlTest {};

// A ramp that rises by a metre in two: each line has its known column, each fifth is bold.
TEST_F(ContoursGlTest, LieAtTheirHeights) {
    OverlayStage stage(
        test::made_heights(101, 81, [](int col, int /*row*/) { return 4.0 * (col - 50); }));
    constexpr double metre = 0.5; // a pixel; its height 0.25 m
    stage.look_down_at({0.0, 0.0}, metre);
    constexpr double interval = 5.0;
    const std::vector<double> ink = ink_of(stage, interval);
    for (int col = 0; col < overlay_picture.x; ++col) {
        const double height = 0.25 * (col + 0.5 - 0.5 * overlay_picture.x);
        const double number = std::round(height / interval);
        const double pixels = std::abs(height - number * interval) / 0.25;
        const bool is_bold = std::fmod(number, 5.0) == 0.0;
        const double line = std::min(std::max((is_bold ? 1.3 : 1.0) - pixels, 0.0), 1.0);
        EXPECT_NEAR(ink[static_cast<std::size_t>(col)], line * (is_bold ? 0.6 : 0.4), 0.03) << col;
    }
}

TEST_F(ContoursGlTest, LevelGroundAtTheHeightOfALineHasNone) {
    OverlayStage stage(test::made_heights(101, 81, [](int, int) { return 50.0; }));
    stage.look_down_at({0.0, 0.0}, 0.5);
    for (const double ink : ink_of(stage, 10.0)) {
        EXPECT_EQ(ink, 0.0);
    }
}

// Normals of level triangles are rounded.
TEST_F(ContoursGlTest, LevelGroundAtZeroHasNoneInOpenGl) {
    OverlayStage stage(test::made_heights(101, 81, [](int, int) { return 0.0; }));
    stage.look(test::camera_at({-20.0, -30.0, 3.0}, {5.0, 40.0, 0.0}));
    for (const char* const technique : {"exact", "polygons"}) {
        const auto drawn = [&](double interval) {
            stage.node().contours = interval;
            return stage.drawn_by_opengl(technique);
        };
        EXPECT_EQ(drawn(5.0), drawn(0.0)) << technique;
    }
}

TEST_F(ContoursGlTest, FadeWhereTheyCrowd) {
    OverlayStage stage(
        test::made_heights(101, 81, [](int col, int /*row*/) { return 4.0 * (col - 50); }));
    stage.look_down_at({0.0, 0.0}, 0.5);
    for (const double ink : ink_of(stage, 0.1)) { // 2.5 lines a pixel
        EXPECT_EQ(ink, 0.0);
    }
}

TEST_F(ContoursGlTest, RaysAndShadersShowTheSame) {
    OverlayStage stage;
    stage.node().contours = 10.0;
    // The last one has slivers.
    for (const char* const technique : {"exact", "polygons", "polygons:error=0.1"}) {
        for (const scene::Pose pose : {scene::Pose::low, scene::Pose::oblique}) {
            stage.look_from(pose);
            stage.node().material.technique = {scene::Exact{}};
            const Image rays = stage.drawn();
            const auto errors = truth::image_errors(rays, stage.drawn_by_opengl(technique));
            ASSERT_TRUE(errors);
            EXPECT_LE(errors->rmse, 0.02) << technique << ' ' << scene::to_string(pose);
        }
    }
}

TEST_F(ContoursGlTest, HideWhilePicturesAreCompared) {
    OverlayStage stage;
    stage.look_from(scene::Pose::low);
    const Image plain = stage.drawn();
    stage.node().contours = 10.0;
    stage.set_grain(1.0F);
    EXPECT_NE(stage.drawn(), plain);
    stage.node().hides_overlay = true;
    EXPECT_EQ(stage.drawn(), plain);
}

TEST_F(ContoursGlTest, ChangeNoHit) {
    OverlayStage stage;
    stage.look_from(scene::Pose::low);
    const HitBuffer without = stage.hits();
    stage.node().contours = 10.0;
    const HitBuffer with = stage.hits();
    for (int row = 0; row < overlay_picture.y; ++row) {
        for (int col = 0; col < overlay_picture.x; ++col) {
            ASSERT_EQ(with(col, row).depth, without(col, row).depth);
        }
    }
}

} // namespace
} // namespace reljef::cast
