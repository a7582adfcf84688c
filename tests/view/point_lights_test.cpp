#include "engine/view/draw_list.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "engine/view/select.h"
#include "tests/render/made_scene.h"

namespace reljef::view {
namespace {

constexpr glm::ivec2 lamp_picture{320, 240};

// Level ground of 100 m; the eye looks north from its southern border.
struct LampScene {
    scene::Scene scene;
    scene::Node* terrain = nullptr;

    LampScene() {
        terrain = &test::add_terrain(
            scene, test::plane_heightfield(
                       test::made_heights(401, 401, [](int, int) { return 0.0; }), {0.25, 0.25}));
        scene.add_camera(test::camera_at({0.0, -50.0, 5.0}, {0.0, 0.0, 5.0}));
    }
    void add(glm::dvec3 place, float intensity = 10.0F, float range = 20.0F) {
        scene.add_point_light({.intensity = intensity, .range = range}, place);
    }
    [[nodiscard]] DrawList list() const { return select(scene, lamp_picture).list; }
};

TEST(SeenPointLights, AreThoseWhoseRangeMeetsTheView) {
    LampScene made;
    made.add({0.0, 0.0, 3.0});
    made.add({0.0, -60.0, 3.0}, 10.0F, 9.0F);  // behind the eye
    made.add({0.0, -60.0, 3.0}, 11.0F, 30.0F); // behind it, but its light is seen
    made.add({300.0, 0.0, 3.0});
    made.add({0.0, 0.0, 3.0}, 12.0F, 0.0F); // gives no light
    const DrawList list = made.list();
    ASSERT_EQ(list.point_lights.size(), 2U);
    EXPECT_EQ(list.point_lights[0].light.intensity, 11.0F);
    EXPECT_EQ(list.point_lights[1].light.intensity, 10.0F);
    EXPECT_EQ(list.stats.skipped.point_lights, 0);
}

TEST(SeenPointLights, HoldParallelOnesWhereverTheCameraLooks) {
    LampScene made;
    made.scene.add_light();
    made.scene.add_light({.color = glm::vec3(0.1F)});
    for (int i = 0; i < 30; ++i) {
        made.add({2.0 * (i - 15), 10.0, 1.0}, 1.0F, 300.0F);
    }
    for (const double east : {-50.0, 0.0, 50.0}) {
        made.scene.set_active_camera(
            made.scene.add_camera(test::camera_at({0.0, 0.0, 5.0}, {east, 1.0, 5.0})));
        const DrawList list = made.list();
        EXPECT_EQ(list.point_lights.size(), scene::max_shown_point_lights);
        EXPECT_TRUE(std::ranges::any_of(list.point_lights, [](const auto& light) {
            return std::isinf(light.light.range);
        })) << east;
    }
}

// Otherwise light would end at the border of two parts.
TEST(SeenPointLights, OfAPartOfAPictureAreThoseOfTheWhole) {
    LampScene made;
    for (int i = 0; i < 30; ++i) {
        made.add({2.0 * (i - 15), 10.0, 1.0}, 10.0F + static_cast<float>(i), 3.0F);
    }
    const DrawList whole = made.list();
    ASSERT_EQ(whole.point_lights.size(), scene::max_shown_point_lights);
    constexpr glm::ivec2 part{64, 64};
    for (const int first : {0, 128, 256}) {
        const scene::Camera camera =
            scene::part_camera(made.scene.camera(), lamp_picture, {{first, 64}, part});
        scene::Scene scene;
        for (const scene::PlacedPointLight& light : made.scene.point_lights()) {
            scene.add_point_light(light.light, light.place);
        }
        scene.add_camera(camera);
        EXPECT_EQ(select(scene, part).list.point_lights, whole.point_lights) << first;
    }
}

TEST(SeenPointLights, AreAtMostTheBrightestAtTheEyeInAFixedOrder) {
    LampScene made;
    made.add({0.0, 0.0, 3.0}, 1.0F);
    made.add({1.0, 0.0, 3.0}, 1000.0F);
    for (int i = 0; i < 18; ++i) {
        made.add({-2.0, 10.0, 3.0}, 50.0F, 20.0F + static_cast<float>(i)); // equally bright
    }
    const DrawList list = made.list();
    ASSERT_EQ(list.point_lights.size(), scene::max_shown_point_lights);
    EXPECT_EQ(list.stats.skipped.point_lights, 4);
    EXPECT_EQ(list.point_lights.front().light.intensity, 1000.0F);
    for (std::size_t i = 1; i < list.point_lights.size(); ++i) {
        EXPECT_EQ(list.point_lights[i].light.range, 19.0F + static_cast<float>(i));
    }
    EXPECT_EQ(made.list().point_lights, list.point_lights);
}

TEST(SeenPointLights, ReachTheTilesWithinTheirRange) {
    LampScene made;
    made.add({-40.0, 40.0, 1.0}, 10.0F, 8.0F);
    const DrawList list = made.list();
    std::size_t reached = 0;
    for (const TileDraw& draw : list.tiles) {
        const Box& bounds = draw.tile->bounds;
        const glm::dvec2 nearest =
            glm::clamp(glm::dvec2(-40.0, 40.0), glm::dvec2(bounds.low), glm::dvec2(bounds.high));
        const double distance =
            glm::length(glm::dvec3(nearest, 0.0) - glm::dvec3(-40.0, 40.0, 1.0));
        EXPECT_EQ(needs_ground(list, draw), distance < 8.0);
        reached += needs_ground(list, draw) ? 1U : 0U;
    }
    EXPECT_GT(reached, 0U);
    EXPECT_LT(reached, list.tiles.size());
    EXPECT_TRUE(needs_ground(list, list.terrains.front()));
    made.scene.root().children().back()->set_position({0.0, 0.0, 9.0});
    EXPECT_FALSE(needs_ground(made.list(), made.list().terrains.front())) << "high above";
}

TEST(SeenPointLights, ALampThatMovesIsAnotherView) {
    LampScene made;
    made.add({0.0, 0.0, 3.0});
    FrameSelector selector;
    selector.select(made.scene, lamp_picture);
    selector.select(made.scene, lamp_picture);
    EXPECT_EQ(selector.count(), 1);
    made.scene.root().children().back()->set_position({1.0, 0.0, 3.0});
    EXPECT_EQ(selector.select(made.scene, lamp_picture).list.point_lights.front().place.x, 1.0);
    EXPECT_EQ(selector.count(), 2);
}

} // namespace
} // namespace reljef::view
