#include "engine/view/scene_view.h"

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/scene/streaming/tile_stream.h"
#include "tests/render/driver_fixture.h"
#include "tests/session/made_session.h"

namespace reljef::render {
namespace {

using scene::TerrainNode;

// A terrain of which one tile is there, a mesh, a light and a sky.
struct ViewedWorld {
    Scene scene;
    Node* terrain = nullptr;
    Node* mesh = nullptr;
    Node* light = nullptr;
    Node* camera = nullptr;

    ViewedWorld() {
        terrain = &test::add_terrain(scene, test::plane_heightfield(test::hills(65, 65, 5.0)));
        scene::Mesh triangle;
        triangle.positions = {{-10, 0, 20}, {10, 0, 20}, {0, 0, 30}};
        triangle.normals.assign(3, {0, -1, 0});
        triangle.texture_coordinates.resize(3);
        triangle.indices = {0, 1, 2};
        mesh = &scene.add_mesh(std::move(triangle));
        light = &scene.add_light();
        camera = &scene.add_camera(pose(scene::Pose::overview, *terrain));
        scene.set_sky({});
    }
    [[nodiscard]] TerrainNode& ground() const { return *terrain->get<TerrainNode>(); }
};

struct SceneChange {
    std::string name;
    std::function<void(ViewedWorld&)> make;
};

std::vector<SceneChange> scene_changes() {
    return {
        {"eye", [](ViewedWorld& world) { world.camera->get<Camera>()->eye.x += 1.0; }},
        {"fov", [](ViewedWorld& world) { world.camera->get<Camera>()->vertical_fov = 40.0; }},
        {"camera node",
         [](ViewedWorld& world) {
             world.camera->set_position({0, 0, 1});
         }},
        {"another camera",
         [](ViewedWorld& world) {
             world.scene.set_active_camera(world.scene.add_camera(Camera{}));
             world.camera->get<Camera>()->eye.x -= 2.0;
         }},
        {"facing",
         [](ViewedWorld& world) {
             world.mesh->get<scene::MeshNode>()->facing = scene::Facing::camera;
         }},
        {"sun", [](ViewedWorld& world) { world.light->get<scene::Light>()->altitude = 10.0; }},
        {"no sun", [](ViewedWorld& world) { world.light->set_visible(false); }},
        {"sky", [](ViewedWorld& world) { world.scene.set_sky({.visibility = 100.0}); }},
        {"no sky", [](ViewedWorld& world) { world.scene.remove_sky(); }},
        {"terrain's place",
         [](ViewedWorld& world) {
             world.terrain->set_position({0, 0, 3});
         }},
        {"technique",
         [](ViewedWorld& world) {
             world.ground().material.technique = scene::parse_technique("polygons:error=2").value();
         }},
        {"wireframe", [](ViewedWorld& world) { world.ground().material.wireframe = true; }},
        {"surface",
         [](ViewedWorld& world) {
             Scene other;
             world.ground().surface =
                 test::add_terrain(other, test::plane_heightfield(test::hills(33, 33, 5.0)))
                     .get<TerrainNode>()
                     ->surface;
         }},
        {"detail",
         [](ViewedWorld& world) {
             world.ground().detail = std::make_shared<const scene::TerrainDetail>();
         }},
        {"mesh",
         [](ViewedWorld& world) {
             world.mesh->get<scene::MeshNode>()->mesh = std::make_shared<const scene::Mesh>();
         }},
        {"mesh's colour",
         [](ViewedWorld& world) {
             world.mesh->get<scene::MeshNode>()->material.color = glm::vec3(0.1F);
         }},
        {"a hidden node", [](ViewedWorld& world) { world.mesh->set_visible(false); }},
        {"one more", [](ViewedWorld& world) { world.scene.root().add("empty"); }},
        {"one less", [](ViewedWorld& world) { world.scene.root().remove(*world.terrain); }},
    };
}

TEST(SceneViews, AnythingThatChangesIsSeenOnceAndNothingElse) {
    for (const SceneChange& change : scene_changes()) {
        ViewedWorld world;
        view::SceneView view;
        EXPECT_TRUE(view.look(world.scene, size));
        EXPECT_FALSE(view.look(world.scene, size));
        change.make(world);
        EXPECT_TRUE(view.look(world.scene, size)) << change.name;
        EXPECT_FALSE(view.look(world.scene, size)) << change.name;
        EXPECT_TRUE(view.look(world.scene, size + 1)) << change.name;
    }
}

TEST(SceneViews, TilesThatComeAreSeen) {
    ViewedWorld world;
    const terrain::TileTree tree(65, 65);
    const auto read = [tree](terrain::TreeTile tile, const std::stop_token&) {
        scene::TileContent reading;
        reading.heights = Grid<float>(tree.cells(tile).x + 3, tree.cells(tile).y + 3);
        return reading;
    };
    world.ground().stream = std::make_shared<scene::TileStream>(
        scene::TileBuilder(world.ground().surface, tree, 1), read);
    view::SceneView view(world.scene, size);
    EXPECT_FALSE(view.look(world.scene, size));
    const std::array requested{tree.root()};
    world.ground().stream->request(requested);
    world.ground().stream->wait({});
    EXPECT_TRUE(view.look(world.scene, size));
    EXPECT_FALSE(view.look(world.scene, size));
}

class StillView : public DriverGlTest {};

TEST_F(StillView, IsDecidedOnceAndDrawnTheSame) {
    World world;
    session::SceneRenderer made = driver();
    EXPECT_EQ(test::must(made.draw(world.scene)).skipped.selections_unchanged, 0);
    const Image first = made.read_color();
    const view::FrameStats still = test::must(made.draw(world.scene));
    EXPECT_EQ(still.skipped.selections_unchanged, 1);
    EXPECT_EQ(made.read_color(), first);
    world.look(pose(scene::Pose::low, *world.terrain));
    const view::FrameStats moved = test::must(made.draw(world.scene));
    EXPECT_EQ(moved.skipped.selections_unchanged, 0);
    EXPECT_EQ(made.read_color(), draw(world.scene));
}

TEST_F(StillView, IsDecidedAnewWhereThatIsMeasured) {
    World world;
    session::SceneRenderer made = test::must(session::SceneRenderer::create(
        {.opengl = render::DriverOptions{.size = size, .shader_dir = {}},
         .select = {},
         .selects_always = true}));
    for (int frame = 0; frame < 2; ++frame) {
        EXPECT_EQ(test::must(made.draw(world.scene)).skipped.selections_unchanged, 0);
    }
}

TEST_F(StillView, HoldsNoSurfaceThatItWasToldToForget) {
    auto world = std::make_unique<World>();
    const std::weak_ptr<const scene::TerrainSurface> surface =
        world->terrain->get<scene::TerrainNode>()->surface;
    session::SceneRenderer made = driver();
    test::must(made.draw(world->scene));
    world.reset();
    made.forget_scene();
    EXPECT_TRUE(surface.expired());
}

} // namespace
} // namespace reljef::render
