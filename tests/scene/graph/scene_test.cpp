#include "engine/scene/graph/scene.h"

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/terrain/made_heightfield.h"

namespace reljef::scene {
namespace {

using testing::ElementsAre;

terrain::Terrain terrain_of(terrain::Heightfield heightfield) {
    return {"made", std::move(heightfield), {}, {}};
}

Node& add(Scene& scene, terrain::Heightfield heightfield, const TerrainOptions& options = {}) {
    auto node = scene.add_terrain(terrain_of(std::move(heightfield)), options);
    EXPECT_TRUE(node);
    return **node;
}

glm::dmat4 rotation(double angle, glm::dvec3 axis) {
    return glm::rotate(glm::dmat4(1.0), angle, glm::normalize(axis));
}

glm::dvec3 moved(const glm::dmat4& transform, glm::dvec3 point) {
    return glm::dvec3(transform * glm::dvec4(point, 1.0));
}

TEST(Node, WorldFromLocalGoesThroughAllParents) {
    Node root("root");
    Node& a = root.add("a");
    Node& b = a.add("b");
    Node& c = b.add("c");
    root.set_position({100.0, 0.0, 0.0});
    a.set_parent_from_local(rotation(glm::radians(90.0), {0.0, 0.0, 1.0}));
    b.set_position({0.0, 5.0, 0.0});
    c.set_position({1.0, 0.0, 0.0});
    EXPECT_EQ(b.parent(), &a);
    EXPECT_EQ(root.parent(), nullptr);
    EXPECT_LE(glm::distance(moved(c.world_from_local(), glm::dvec3(0.0)), {95.0, 1.0, 0.0}), 1e-12);
}

TEST(Node, RemovedChildrenStandOnTheirOwn) {
    Node root("root");
    root.set_position({1.0, 0.0, 0.0});
    Node& first = root.add("first");
    Node& second = root.add("second");
    first.set_position({0.0, 1.0, 0.0});
    EXPECT_EQ(root.remove(root), nullptr) << "none of its own children";
    const auto taken = root.remove(first);
    ASSERT_NE(taken, nullptr);
    EXPECT_EQ(taken->parent(), nullptr);
    EXPECT_EQ(moved(taken->world_from_local(), glm::dvec3(0.0)), glm::dvec3(0.0, 1.0, 0.0));
    ASSERT_EQ(root.children().size(), 1U);
    EXPECT_EQ(root.children().front().get(), &second);
    EXPECT_EQ(root.remove(*taken), nullptr);
}

TEST(Node, BoundsHoldRotatedChildren) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (int round = 0; round < 200; ++round) {
        Scene scene;
        Node& mesh = scene.add_mesh(box_mesh({2.0F, 4.0F, 6.0F}));
        mesh.set_parent_from_local(rotation(3.0 * any(random), {any(random), any(random), 1.1}));
        scene.root().set_parent_from_local(glm::translate(
            rotation(any(random), {1.0, 0.1, any(random)}), {10.0, 20.0, any(random)}));
        const Box bounds = scene.root().world_bounds();
        for (const glm::vec3& corner : mesh.get<MeshNode>()->mesh->positions) {
            const glm::dvec3 at = moved(mesh.world_from_local(), glm::dvec3(corner));
            ASSERT_TRUE(glm::all(glm::greaterThanEqual(at, bounds.low - 1e-9)));
            ASSERT_TRUE(glm::all(glm::lessThanEqual(at, bounds.high + 1e-9)));
        }
    }
}

TEST(Node, InvisibleOnesHideTheirChildren) {
    Scene scene;
    Node& group = scene.root().add("group");
    group.add("mesh", MeshNode{std::make_shared<const Mesh>(box_mesh({1.0F, 1.0F, 1.0F})), {}});
    std::vector<std::string> seen;
    const auto visit = [&] {
        seen.clear();
        visit_visible(scene.root(),
                      [&](const Node& node, const glm::dmat4&) { seen.push_back(node.name()); });
    };
    visit();
    EXPECT_THAT(seen, ElementsAre("root", "group", "mesh"));
    EXPECT_FALSE(scene.root().world_bounds().empty());
    group.set_visible(false);
    visit();
    EXPECT_THAT(seen, ElementsAre("root"));
    EXPECT_TRUE(scene.root().world_bounds().empty());
}

TEST(Node, HiddenTerrainIsNeitherPickedNorStoodOn) {
    Scene scene;
    Node& node = add(scene, test::plane_heightfield(Grid<float>(5, 5, 7.0F)));
    ASSERT_TRUE(scene.height_at(0.0, 0.0));
    node.set_visible(false);
    EXPECT_FALSE(scene.height_at(0.0, 0.0));
    EXPECT_FALSE(scene.pick({{0.0, 0.0, 100.0}, {0.0, 0.0, -1.0}}));
}

TEST(Node, AnimatesParentsBeforeChildren) {
    Node root("root");
    Node& child = root.add("child");
    std::vector<std::string> order;
    child.add_animator([&](Node& node, double time) {
        order.push_back(node.name());
        EXPECT_EQ(time, 2.5);
    });
    root.add_animator([&](Node& node, double) { order.push_back(node.name() + "1"); });
    root.add_animator([&](Node& node, double) { order.push_back(node.name() + "2"); });
    root.animate(2.5);
    EXPECT_THAT(order, ElementsAre("root1", "root2", "child"));
}

TEST(Light, ComesFromItsAzimuthAndAltitude) {
    EXPECT_LE(glm::distance(to_light({.azimuth = 90.0, .altitude = 0.0}), {1.0, 0.0, 0.0}), 1e-12);
    EXPECT_LE(glm::distance(to_light({.azimuth = 0.0, .altitude = 45.0}),
                            glm::normalize(glm::dvec3(0.0, 1.0, 1.0))),
              1e-12);
    EXPECT_LE(glm::distance(to_light({.azimuth = 217.0, .altitude = 90.0}), {0.0, 0.0, 1.0}),
              1e-12);
}

TEST(Scene, TheFirstCameraIsActiveUntilAnotherOneIs) {
    Scene scene;
    EXPECT_EQ(scene.camera().vertical_fov, Camera{}.vertical_fov);
    Camera camera;
    camera.vertical_fov = 10.0;
    scene.add_camera(camera);
    camera.vertical_fov = 20.0;
    Node& second = scene.add_camera(camera);
    EXPECT_EQ(scene.camera().vertical_fov, 10.0);
    scene.set_active_camera(second);
    EXPECT_EQ(scene.camera().vertical_fov, 20.0);
}

TEST(Scene, TheCameraMovesWithItsNode) {
    Scene scene;
    Camera camera;
    camera.eye = {1.0, 0.0, 0.0};
    camera.target = {2.0, 0.0, 0.0};
    Node& node = scene.add_camera(camera);
    node.set_parent_from_local(glm::translate(glm::dmat4(1.0), {0.0, 0.0, 7.0}) *
                               rotation(glm::radians(90.0), {0.0, 0.0, 1.0}));
    EXPECT_LE(glm::distance(scene.camera().eye, {0.0, 1.0, 7.0}), 1e-12);
    EXPECT_LE(glm::distance(scene.camera().target, {0.0, 2.0, 7.0}), 1e-12);
    EXPECT_LE(glm::distance(scene.camera().up, {0.0, 0.0, 1.0}), 1e-12);
}

TEST(SceneDeathTest, OnlyACameraCanBeActive) {
    Scene scene;
    EXPECT_DEATH(scene.set_active_camera(scene.root()), "camera node");
}

TEST(Scene, AsksTheLatestReceiverFirstUntilOneTakesTheEvent) {
    Scene scene;
    std::vector<int> asked;
    EXPECT_FALSE(scene.dispatch(CloseEvent{}));
    for (int i = 0; i < 4; ++i) {
        scene.add_event_receiver([&asked, i](const Event&) {
            asked.push_back(i);
            return i == 1;
        });
    }
    EXPECT_TRUE(scene.dispatch(CloseEvent{}));
    EXPECT_THAT(asked, ElementsAre(3, 2, 1));
}

terrain::Heightfield bumpy(unsigned seed) {
    return test::plane_heightfield(test::random_heights(41, 31, -20.0F, 60.0F, seed), {10.0, 12.0});
}

TEST(Scene, HeightAtAndPickAndTheBilinearHeightAgree) {
    Scene scene;
    Node& node = add(scene, bumpy(3), {.placement = {}, .exaggeration = 2.0});
    const auto& surface = *node.get<TerrainNode>()->surface;
    std::mt19937 random(2);
    std::uniform_real_distribution<double> x(-220.0, 220.0);
    std::uniform_real_distribution<double> y(-200.0, 200.0);
    for (int i = 0; i < 5000; ++i) {
        const glm::dvec2 at{x(random), y(random)};
        const auto height = scene.height_at(at.x, at.y);
        const auto pick = scene.pick({{at, 1000.0}, {0.0, 0.0, -1.0}});
        ASSERT_EQ(height.has_value(), std::abs(at.x) <= 200.0 && std::abs(at.y) <= 180.0);
        ASSERT_EQ(height.has_value(), pick.has_value());
        if (height) {
            const double expected =
                2.0 * terrain::bilinear_height(
                          surface.heightfield().heights.view(),
                          glm::dvec2(*surface.placement().sample_from_world({at, 0.0})));
            ASSERT_NEAR(*height, expected, 1e-9);
            ASSERT_NEAR(pick->world.z, expected, 1e-9);
            ASSERT_EQ(pick->node, &node);
        }
    }
}

TEST(Scene, HeightAtAndPickFollowTheNode) {
    Scene scene;
    Node& node = add(scene, bumpy(4));
    const auto& surface = *node.get<TerrainNode>()->surface;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-120.0, 120.0);
    for (const glm::dmat4& transform :
         {glm::translate(glm::dmat4(1.0), {1e6, -2e6, 300.0}),
          glm::translate(glm::dmat4(1.0), {5.0, 6.0, 7.0}) * rotation(0.7, {0.0, 0.0, 1.0}),
          glm::scale(glm::translate(glm::dmat4(1.0), {5.0, 6.0, 7.0}), {2.0, 3.0, 0.5})}) {
        node.set_parent_from_local(transform);
        for (int i = 0; i < 500; ++i) {
            const glm::dvec2 local{place(random), place(random)};
            const glm::dvec3 expected =
                moved(transform, {local, surface.height_at(local.x, local.y).value()});
            const auto height = scene.height_at(expected.x, expected.y);
            ASSERT_TRUE(height);
            ASSERT_NEAR(*height, expected.z, 1e-7);
            const auto pick =
                scene.pick({{expected.x, expected.y, expected.z + 500.0}, {0.0, 0.0, -2.0}});
            ASSERT_TRUE(pick);
            ASSERT_LE(glm::distance(pick->world, expected), 1e-6);
        }
    }
}

TEST(Scene, OfSeveralTerrainsTheHighestAndTheFirstCount) {
    Scene scene;
    Node& low = add(scene, test::plane_heightfield(Grid<float>(5, 5, 1.0F)));
    Node& high = add(scene, test::plane_heightfield(Grid<float>(3, 3, 4.0F)));
    EXPECT_EQ(scene.height_at(0.0, 0.0), 4.0);
    EXPECT_EQ(scene.height_at(1.5, 1.5), 1.0);
    EXPECT_EQ(scene.pick({{0.0, 0.0, 9.0}, {0.0, 0.0, -1.0}})->node, &high);
    EXPECT_EQ(scene.pick({{0.0, 0.0, 3.0}, {0.0, 0.0, -1.0}})->node, &low);
    EXPECT_FALSE(scene.height_at(10.0, 0.0));
}

// At 45 km from the middle the vertical of an ellipsoid leans 0.4° against z.
TEST(Scene, HeightAtAndPickAgreeOnAnEllipsoid) {
    Scene scene;
    Node& node = add(scene, test::geographic_heightfield(
                                test::made_heights(121, 101,
                                                   [](int col, int row) {
                                                       return 2000.0 + 1500.0 *
                                                                           std::sin(0.3 * col) *
                                                                           std::sin(0.2 * row);
                                                   }),
                                46.0, 7.0, 0.01));
    EXPECT_EQ(node.get<TerrainNode>()->surface->placement().kind(),
              terrain::PlacementKind::ellipsoid);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> x(-4.9e4, 4.9e4);
    std::uniform_real_distribution<double> y(-5.8e4, 5.8e4);
    int inside = 0;
    for (int i = 0; i < 300; ++i) {
        const glm::dvec2 at{x(random), y(random)};
        const auto height = scene.height_at(at.x, at.y);
        const auto pick = scene.pick({{at, 1e4}, {0.0, 0.0, -1.0}});
        ASSERT_EQ(height.has_value(), pick.has_value()) << at.x << ' ' << at.y;
        if (height) {
            ++inside;
            ASSERT_NEAR(*height, pick->world.z, 0.02);
        }
    }
    EXPECT_GT(inside, 200);
}

// Where the ground is high, a place may lie over the heightfield at its height and not at sea
// level.
TEST(Scene, HeightAtTheBorderOfAnEllipsoidIsThatOfTheGround) {
    Scene scene;
    Node& node =
        add(scene, test::geographic_heightfield(Grid<float>(121, 101, 4000.0F), 46.0, 7.0, 0.01));
    const auto& surface = *node.get<TerrainNode>()->surface;
    for (int i = 0; i <= 100; ++i) {
        const glm::dvec3 just_inside = surface.placement().world_from_sample({0.001, i, 4000.0});
        const glm::dvec3 just_outside = surface.placement().world_from_sample({-0.001, i, 4000.0});
        const bool inner = i > 0 && i < 100;
        EXPECT_EQ(scene.height_at(just_inside.x, just_inside.y).has_value() || !inner, true) << i;
        EXPECT_FALSE(scene.height_at(just_outside.x, just_outside.y)) << i;
    }
}

TEST(Scene, ATerrainThatCannotBePlacedIsAnError) {
    Scene scene;
    const auto failed =
        scene.add_terrain(terrain_of(test::plane_heightfield(Grid<float>(3, 3, 0.0F))),
                          {.placement = terrain::PlacementKind::ellipsoid});
    EXPECT_FALSE(failed);
    EXPECT_TRUE(scene.root().children().empty());
    EXPECT_FALSE(scene.add_terrain(terrain_of(test::plane_heightfield(Grid<float>(3, 3, 0.0F))),
                                   {.placement = {}, .exaggeration = 0.0}));
}

TEST(Scene, AnEmptyOneHasNoHeightAndNothingToPick) {
    const Scene scene;
    EXPECT_FALSE(scene.height_at(0.0, 0.0));
    EXPECT_FALSE(scene.pick({}));
}

TEST(Scene, PickMeetsTheFirstOfGroundAndMeshes) {
    Scene scene;
    Node& ground = add(scene, test::plane_heightfield(Grid<float>(9, 9, 1.0F)));
    Node& tower = scene.root().add("tower");
    const auto box = std::make_shared<const Mesh>(box_mesh(glm::vec3(2.0F)));
    Node& part = tower.add("part", MeshNode{box, {}});
    tower.set_position({1.0, 1.0, 4.0});
    const auto down = [&](double x, double z) {
        return scene.pick({{x, 1.0, z}, {0.0, 0.0, -2.0}});
    };
    EXPECT_EQ(down(0.5, 9.0)->node, &part);
    EXPECT_EQ(down(0.5, 9.0)->world.z, 5.0);
    EXPECT_EQ(down(0.5, 9.0)->t, 2.0);
    EXPECT_FALSE(down(0.5, 9.0)->ground);
    EXPECT_EQ(object_name(*down(0.5, 9.0)->node), "tower");
    EXPECT_EQ(down(-1.5, 9.0)->node, &ground);
    EXPECT_EQ(down(-1.5, 9.0)->ground->sample.z, 1.0);
    EXPECT_EQ(down(0.5, 2.0)->node, &ground) << "below the box";
    tower.set_position({1.0, 1.0, -4.0});
    EXPECT_EQ(down(0.5, 9.0)->node, &ground) << "the box is below";
    tower.set_position({1.0, 1.0, 4.0});
    tower.set_visible(false);
    EXPECT_EQ(down(0.5, 9.0)->node, &ground);
}

TEST(Scene, PickMeshMeetsTheFirstTriangleOfARangeFromOutside) {
    Scene scene;
    const auto box = std::make_shared<const Mesh>(box_mesh(glm::vec3(2.0F)));
    Node& low = scene.root().add("low", MeshNode{box, {}});
    Node& high = scene.root().add("high", MeshNode{box, {}});
    high.set_position({0.0, 0.0, 6.0});
    const Ray down{{0.5, 0.25, 17.0}, {0.0, 0.0, -2.0}};
    EXPECT_EQ(scene.pick_mesh(down)->node, &high);
    EXPECT_EQ(scene.pick_mesh(down)->t, 5.0);
    EXPECT_EQ(scene.pick_mesh(down)->normal, glm::dvec3(0.0, 0.0, 1.0));
    EXPECT_EQ(scene.pick_mesh(down, {5.5, 10.0})->node, &low);
    EXPECT_EQ(scene.pick_mesh(down, {5.5, 10.0})->t, 8.0);
    EXPECT_FALSE(scene.pick_mesh(down, {0.0, 4.5}));
    EXPECT_FALSE(scene.pick_mesh(down, {8.5, 100.0})) << "from inside";
}

TEST(Scene, PickMeetsABillboardAsTheCameraSeesIt) {
    Scene scene;
    scene.add_camera({.eye = {50.0, 0.0, 0.0}, .target = {0.0, 0.0, 0.0}});
    const auto mesh = std::make_shared<const Mesh>(billboard_mesh({2.0F, 4.0F}));
    Node& node = scene.root().add("tree", MeshNode{mesh, {}, Facing::upright});
    const Ray ray{{50.0, 0.5, 1.0}, {-1.0, 0.0, 0.0}};
    ASSERT_TRUE(scene.pick(ray));
    EXPECT_NEAR(scene.pick(ray)->t, 50.0, 1e-9);
    node.get<MeshNode>()->facing = Facing::node;
    EXPECT_FALSE(scene.pick(ray)) << "seen along its plane";
    node.set_parent_from_local(glm::scale(glm::dmat4(1.0), {1.0, 1.0, 0.0}));
    EXPECT_FALSE(scene.pick(ray)) << "without area";
}

TEST(Scene, ARemovedCameraIsNoLongerLookedThrough) {
    Scene scene;
    Camera camera;
    camera.eye = {1.0, 2.0, 3.0};
    Node& node = scene.add_camera(camera);
    EXPECT_EQ(scene.camera().eye, camera.eye);
    scene.root().remove(node);
    EXPECT_EQ(scene.camera().eye, Camera().eye);
}

TEST(TriangleBound, IsThereIfMemoryDoesNotHoldAVertexAtEachSample) {
    Scene scene;
    auto& node = *add(scene, test::plane_heightfield(Grid<float>(5, 4, 0.0F))).get<TerrainNode>();
    const auto bound = [&](const Polygons& polygons) {
        return triangle_bound(node, Technique{polygons});
    };
    node.max_vertices = 20;
    EXPECT_EQ(bound({}), 0.0);
    node.max_vertices = 19;
    EXPECT_EQ(bound({}), bound_for_many_samples);
    EXPECT_EQ(bound({.error = 3.0}), 3.0);
    EXPECT_EQ(bound({.max_levels = 2}), 0.0);
    EXPECT_EQ(triangle_bound(node, Technique{Texture{}}), 0.0);
}

TEST(Light, TurnsWithItsNode) {
    Light light;
    light.azimuth = 90.0;
    light.altitude = 30.0;
    const auto quarter =
        glm::rotate(glm::dmat4(1.0), glm::radians(90.0), glm::dvec3(0.0, 0.0, 1.0));
    const Light turned_light = turned(light, quarter); // from the east to the north
    EXPECT_NEAR(turned_light.azimuth, 0.0, 1e-9);
    EXPECT_NEAR(turned_light.altitude, 30.0, 1e-9);
    EXPECT_EQ(turned(light, glm::dmat4(1.0)), light);
}

} // namespace
} // namespace reljef::scene
