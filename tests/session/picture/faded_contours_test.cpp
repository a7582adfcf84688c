#include "engine/session/picture/faded_contours.h"

#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/made_hill.h"

namespace reljef::session {
namespace {

using ::testing::HasSubstr;

constexpr glm::ivec2 faded_size{320, 240};
constexpr double rise = 0.5; // metres of height a metre

// 640 m wide, rising to the east.
TerrainScene slope_scene(double contours, const SceneOptions& view) {
    Grid<float> heights(65, 65);
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            heights(col, row) = static_cast<float>(rise * 10.0 * col);
        }
    }
    TerrainScene scene = app::scene_of(std::move(heights), view);
    scene.terrain->get<scene::TerrainNode>()->contours = contours;
    return scene;
}

SceneOptions map_of_slope() {
    SceneOptions view;
    view.projection = scene::ProjectionKind::orthographic;
    view.size = faded_size;
    return view;
}

SceneOptions view_of_slope(double height) {
    SceneOptions view;
    view.size = faded_size;
    view.eye = glm::dvec3(0.0, -1.0, 160.0 + height);
    view.target = glm::dvec3(0.0, 0.0, 160.0);
    return view;
}

// On a plane seen from above, lines are interval / slope / pixel apart.
TEST(FadedContours, AreFoundFromTheDistanceBetweenLinesOnAMap) {
    const TerrainScene map = slope_scene(1.0, map_of_slope());
    const double pixel = map.camera->get<scene::Camera>()->view_height / faded_size.y;
    const double half_ink = 5.5 * pixel * rise; // metres of height
    TerrainScene scene = slope_scene(1.02 * half_ink, map_of_slope());
    EXPECT_FALSE(faded_contours(scene, faded_size));
    scene.terrain->get<scene::TerrainNode>()->contours = 0.98 * half_ink;
    const auto faded = faded_contours(scene, faded_size);
    ASSERT_TRUE(faded);
    EXPECT_TRUE(faded->shows_bold);
    EXPECT_FALSE(faded->shown_distance);
    EXPECT_GE(faded->shown_interval, half_ink);
    EXPECT_LE(faded->shown_interval, 2.5 * half_ink);
    scene.terrain->get<scene::TerrainNode>()->contours = 0.19 * half_ink;
    EXPECT_FALSE(faded_contours(scene, faded_size)->shows_bold);
}

TEST(FadedContours, ShowAtTheIntervalAndTheDistanceThatAreNamed) {
    constexpr double height = 1500.0;
    TerrainScene scene = slope_scene(2.0, view_of_slope(height));
    const auto faded = faded_contours(scene, faded_size);
    ASSERT_TRUE(faded);
    scene.terrain->get<scene::TerrainNode>()->contours = faded->shown_interval;
    EXPECT_FALSE(faded_contours(scene, faded_size));
    ASSERT_TRUE(faded->shown_distance);
    EXPECT_LT(*faded->shown_distance, height);
    EXPECT_FALSE(
        faded_contours(slope_scene(2.0, view_of_slope(0.85 * *faded->shown_distance)), faded_size));
    EXPECT_TRUE(
        faded_contours(slope_scene(2.0, view_of_slope(1.2 * *faded->shown_distance)), faded_size));
}

TEST(FadedContours, AreNoneWhereNoContoursAreDrawn) {
    EXPECT_FALSE(faded_contours(slope_scene(0.0, map_of_slope()), faded_size));
    TerrainScene scene = slope_scene(0.1, map_of_slope());
    EXPECT_TRUE(faded_contours(scene, faded_size));
    scene.terrain->get<scene::TerrainNode>()->hides_overlay = true;
    EXPECT_FALSE(faded_contours(scene, faded_size));
    TerrainScene level = app::scene_of(Grid<float>(9, 9, 100.0F), map_of_slope());
    level.terrain->get<scene::TerrainNode>()->contours = 0.1;
    EXPECT_FALSE(faded_contours(level, faded_size));
}

TEST(FadedContours, HaveASentence) {
    EXPECT_EQ(
        faded_text({true, 1000.0, 12'345.0}, 200.0),
        "contours every 200 m are too close together to show on most of this view (only every "
        "fifth one shows): every 1000 m would show here, every 200 m from within 12 km of "
        "the ground");
    EXPECT_THAT(faded_text({false, 0.5, 87.3}, 0.1), HasSubstr("every 0.1 m are too close"));
    EXPECT_THAT(faded_text({false, 0.5, 87.3}, 0.1), HasSubstr("within 87 m"));
    EXPECT_THAT(faded_text({false, 0.5, {}}, 0.1), HasSubstr("closer map"));
}

} // namespace
} // namespace reljef::session
