#include "engine/session/picture/scene_marks.h"

#include <cmath>
#include <memory>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/scene/streaming/terrain_surface.h"
#include "tests/app/made_hill.h"

namespace reljef::session {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr io::MarksDescription all_marks{true, true, true};
constexpr glm::ivec2 picture_size{320, 240};

SceneOptions map_view() {
    SceneOptions view;
    view.projection = scene::ProjectionKind::orthographic;
    view.size = picture_size;
    return view;
}

// A hill with colours of its own, of which `share` is shown.
TerrainScene colored_hill(double share) {
    TerrainScene scene = app::hill_scene();
    auto& node = *scene.terrain->get<scene::TerrainNode>();
    auto terrain = std::make_shared<terrain::Terrain>(node.surface->terrain());
    terrain->color = Image(33, 33, {200, 10, 10, 255});
    scene::TerrainOptions options;
    options.imagery_share = share;
    node.surface = std::make_shared<const scene::TerrainSurface>(
        scene::TerrainSurface::create(std::move(terrain), options).value());
    return scene;
}

TEST(SceneMarks, NoneAreThereUnlessChosen) {
    const auto found = marks_of(app::hill_scene(map_view()), {}, picture_size);
    EXPECT_TRUE(found.marks.empty());
    EXPECT_THAT(found.notes, IsEmpty());
}

TEST(SceneMarks, AMapHasItsScaleEverywhere) {
    const TerrainScene scene = app::hill_scene(map_view());
    const auto found = marks_of(scene, all_marks, picture_size);
    EXPECT_THAT(found.notes, IsEmpty());
    ASSERT_TRUE(found.marks.scale);
    EXPECT_TRUE(found.marks.scale->is_everywhere);
    // Two points of the ground, by the camera's own projection.
    const auto& camera = *scene.camera->get<scene::Camera>();
    const glm::dvec3 from(-100.0, 20.0, 10.0);
    const glm::dvec3 to(50.0, 20.0, 60.0);
    const double pixels = scene::project(camera, picture_size, to).pixel.x -
                          scene::project(camera, picture_size, from).pixel.x;
    EXPECT_NEAR(found.marks.scale->metres_per_pixel * pixels, 150.0, 1e-6);
    EXPECT_NEAR(found.marks.north.value(), 0.0, 1e-9);
}

TEST(SceneMarks, InPerspectiveTheScaleIsThatOfTheMiddle) {
    SceneOptions view;
    view.size = picture_size;
    view.eye = glm::dvec3(0.0, -120.0, 130.0);
    view.target = glm::dvec3(0.0, -60.0, 10.0);
    const TerrainScene scene = app::hill_scene(view);
    const auto found = marks_of(scene, all_marks, picture_size);
    ASSERT_TRUE(found.marks.scale);
    EXPECT_FALSE(found.marks.scale->is_everywhere);
    const auto& camera = *scene.camera->get<scene::Camera>();
    const glm::dvec3 middle(0.0, -60.0, 10.0); // level ground
    const double pixels =
        scene::project(camera, picture_size, middle + glm::dvec3(1, 0, 0)).pixel.x -
        scene::project(camera, picture_size, middle).pixel.x;
    EXPECT_NEAR(found.marks.scale->metres_per_pixel * pixels, 1.0, 1e-3);
}

TEST(SceneMarks, ASkyInTheMiddleHasNoScaleButANote) {
    SceneOptions view;
    view.size = picture_size;
    view.eye = glm::dvec3(0.0, 0.0, 200.0);
    view.target = glm::dvec3(100.0, 0.0, 220.0);
    const auto found = marks_of(app::hill_scene(view), all_marks, picture_size);
    EXPECT_FALSE(found.marks.scale);
    ASSERT_EQ(found.notes.size(), 1U);
    EXPECT_THAT(found.notes[0], HasSubstr("no scale bar is drawn"));
    // The view is to the east, so north is to the left.
    EXPECT_NEAR(std::remainder(found.marks.north.value() + 90.0, 360.0), 0.0, 1e-9);
}

TEST(SceneMarks, TheLegendIsThatOfTheShownRamp) {
    const auto plain = legend_of(app::hill_scene());
    ASSERT_GE(plain.size(), 2U);
    EXPECT_EQ(plain.front().height, 10.0);
    EXPECT_EQ(plain.back().height, 60.0);
    EXPECT_NE(plain.front().color, plain.back().color);
    EXPECT_THAT(legend_of(colored_hill(1.0)), IsEmpty());
    for (const double share : {0.0, 0.5}) {
        const auto mixed = legend_of(colored_hill(share));
        ASSERT_EQ(mixed.size(), plain.size()) << share;
        EXPECT_EQ(mixed.back().color, plain.back().color);
    }
}

TEST(SceneMarks, AMissingLegendIsExplained) {
    const auto colored = marks_of(colored_hill(1.0), {true, false, false}, picture_size);
    ASSERT_EQ(colored.notes.size(), 1U);
    EXPECT_THAT(colored.notes[0], HasSubstr("--imagery-share below 1"));
    const TerrainScene level = app::scene_of(Grid<float>(17, 17, 5.0F));
    const auto flat = marks_of(level, {true, false, false}, picture_size);
    ASSERT_EQ(flat.notes.size(), 1U);
    EXPECT_THAT(flat.notes[0], HasSubstr("all heights are equal"));
}

TEST(SceneMarks, SmallPicturesHaveANoteInstead) {
    const auto found = marks_of(app::hill_scene(), all_marks, {159, 120});
    EXPECT_TRUE(found.marks.empty());
    ASSERT_EQ(found.notes.size(), 1U);
    EXPECT_THAT(found.notes[0], HasSubstr("159x120 pixels have no room"));
}

} // namespace
} // namespace reljef::session
