#include <cmath>
#include <memory>
#include <random>

#include <glm/ext/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "engine/scene/graph/picture_detail.h"
#include "engine/scene/levels/mesh_levels.h"
#include "engine/view/select.h"
#include "tests/render/made_scene.h"

namespace reljef::view {
namespace {

constexpr glm::ivec2 level_picture{320, 240};

// A statue on level ground.
struct StatueScene {
    scene::Scene scene;
    scene::Node* terrain = nullptr;
    scene::Node* statue = nullptr;
    scene::Node* camera = nullptr;

    StatueScene() {
        scene::Mesh mesh = scene::sphere_mesh(10.0F, 96);
        for (glm::vec3& place : mesh.positions) {
            place *= 1.0F + 0.1F * std::sin(1.3F * place.x) * std::sin(0.9F * place.y + place.z);
        }
        terrain = &test::add_terrain(scene, test::plane_heightfield(test::hills(17, 17, 5.0)));
        statue = &scene.add_mesh(std::move(mesh));
        auto& node = *statue->get<scene::MeshNode>();
        node.levels = std::make_shared<const scene::MeshLevels>(*scene::mesh_levels(*node.mesh));
        camera = &scene.add_camera({});
        set_bound(1.0);
    }
    void set_bound(double error) {
        scene::Technique technique = scene::make_technique(scene::TechniqueId::polygons);
        std::get<scene::Polygons>(technique.parameters).error = error;
        terrain->get<scene::TerrainNode>()->material.technique = technique;
    }
    FrameView seen_from(double distance) {
        auto& view = *camera->get<scene::Camera>();
        view.eye = {0.0, -distance, 0.0};
        view.target = {0.0, 0.0, 0.0};
        return select(scene, level_picture);
    }
};

glm::dvec3 place_in(const scene::Mesh& mesh, std::size_t triangle, glm::dvec2 shares) {
    const scene::TriangleEdges edges = scene::triangle_edges(mesh, 3 * triangle);
    return edges.corner + shares.x * edges.p + shares.y * edges.q;
}

// Each visible point of the level is at most the stated pixels from a point of the mesh.
TEST(MeshLevelsInViews, PixelsAreNotFartherOffThanStated) {
    StatueScene world;
    const auto& node = *world.statue->get<scene::MeshNode>();
    const scene::MeshTree whole(*node.mesh);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    int coarse = 0;
    for (int i = 0; i < 400; ++i) {
        world.set_bound(0.25 + 4.0 * share(random));
        auto& camera = *world.camera->get<scene::Camera>();
        const double distance = 12.0 + 3000.0 * std::pow(share(random), 3.0);
        const double turn = 6.28 * share(random);
        camera.eye = {distance * std::cos(turn), distance * std::sin(turn),
                      distance * (share(random) - 0.5)};
        camera.target = 0.4 * distance * (glm::dvec3(share(random), share(random), 0.0) - 0.5);
        camera.vertical_fov = 10.0 + 100.0 * share(random);
        glm::dmat4 placed = glm::scale(glm::dmat4(1.0), glm::dvec3(0.3 + 3.0 * share(random)));
        placed = glm::rotate(placed, turn, glm::dvec3(0.0, 0.6, 0.8));
        world.statue->set_parent_from_local(placed);
        const FrameView frame = select(world.scene, level_picture);
        if (frame.list.meshes.empty() || frame.list.meshes.front().level == 0) {
            continue;
        }
        ++coarse;
        const MeshDraw& draw = frame.list.meshes.front();
        ASSERT_TRUE(frame.list.stats.mesh_error);
        EXPECT_EQ(draw.error, *frame.list.stats.mesh_error);
        const scene::Mesh& mesh = *drawn_mesh(draw);
        for (int j = 0; j < 200; ++j) {
            const double s = share(random);
            const auto triangle = static_cast<std::size_t>(
                share(random) * static_cast<double>(mesh.indices.size() / 3 - 1));
            const glm::dvec3 drawn = place_in(mesh, triangle, {s, (1.0 - s) * share(random)});
            const auto corners = scene::triangle_corners(*node.mesh, whole.nearest_triangle(drawn));
            const auto seen = [&](glm::dvec3 local) {
                return scene::project(camera, level_picture,
                                      glm::dvec3(placed * glm::dvec4(local, 1.0)));
            };
            const auto at = seen(drawn);
            if (at.depth > camera.near && at.pixel.x >= 0.0 && at.pixel.y >= 0.0 &&
                at.pixel.x <= level_picture.x && at.pixel.y <= level_picture.y) {
                EXPECT_LE(glm::distance(at.pixel, seen(scene::nearest_point(corners, drawn)).pixel),
                          draw.error);
            }
        }
    }
    EXPECT_GT(coarse, 100);
}

TEST(MeshLevelsInViews, KeepTheBoundAndGrowWithDistance) {
    StatueScene world;
    std::size_t before = 0;
    for (double distance = 15.0; distance < 1e5; distance *= 2.0) {
        const FrameView frame = world.seen_from(distance);
        ASSERT_EQ(frame.list.meshes.size(), 1U);
        const MeshDraw& draw = frame.list.meshes.front();
        EXPECT_GE(draw.level, before);
        EXPECT_LE(draw.error, 1.0);
        EXPECT_EQ(frame.list.stats.skipped.triangles_under_error > 0, draw.level > 0);
        before = draw.level;
    }
    EXPECT_EQ(before, world.statue->get<scene::MeshNode>()->levels->size());
}

TEST(MeshLevelsInViews, AreNeverDrawnWithoutABound) {
    StatueScene world;
    for (const auto id : {scene::TechniqueId::exact, scene::TechniqueId::texture}) {
        world.terrain->get<scene::TerrainNode>()->material.technique = scene::make_technique(id);
        const FrameView frame = world.seen_from(1e4);
        ASSERT_EQ(frame.list.meshes.size(), 1U);
        EXPECT_EQ(frame.list.meshes.front().level, 0U);
        EXPECT_FALSE(frame.list.stats.mesh_error);
    }
}

TEST(MeshLevelsInViews, AreWholeWhereTheEyeIsWithin) {
    StatueScene world;
    EXPECT_EQ(world.seen_from(3.0).list.meshes.front().level, 0U);
}

// Floats round the corners of large triangles that reach far behind what is seen of them.
TEST(MeshLevelsInViews, OfLargeFlatObjectsAreNotDrawnNearTheEye) {
    StatueScene world;
    auto& node = *world.statue->get<scene::MeshNode>();
    const auto flat = std::make_shared<const scene::Mesh>(scene::plane_mesh(glm::vec2(2000.0F)));
    node.mesh = flat;
    node.levels = std::make_shared<const scene::MeshLevels>(
        scene::MeshLevels{{.mesh = flat, .error = 0.0, .shaded_width = 0.0}});
    auto& camera = *world.camera->get<scene::Camera>();
    const auto level_at = [&](double height) {
        camera.eye = {0.0, 0.0, height};
        camera.target = {1.0, 0.0, 0.0};
        return select(world.scene, level_picture).list.meshes.front().level;
    };
    EXPECT_EQ(level_at(1.0), 0U);
    EXPECT_EQ(level_at(5000.0), 1U);
}

TEST(MeshLevelsInViews, ThatAreShadedOtherwiseAreDrawnSmallOnly) {
    StatueScene world;
    auto& node = *world.statue->get<scene::MeshNode>();
    scene::MeshLevels levels = *node.levels;
    for (scene::MeshLevel& level : levels) {
        level.error = 0.0;
        level.shaded_width = 5.0;
    }
    node.levels = std::make_shared<const scene::MeshLevels>(levels);
    EXPECT_EQ(world.seen_from(100.0).list.meshes.front().level, 0U) << "10 pixels";
    EXPECT_EQ(world.seen_from(1000.0).list.meshes.front().level, levels.size());
}

TEST(MeshLevelsInViews, OfMeshesWithPicturesAreDrawnWhereARepeatIsSmall) {
    StatueScene world;
    auto& node = *world.statue->get<scene::MeshNode>();
    node.material.technique = scene::make_technique(scene::TechniqueId::texture);
    node.material.detail.set = *scene::picture_material(Image(4, 4), "picture");
    EXPECT_EQ(world.seen_from(1e4).list.meshes.front().level, 0U) << "levels of a plain mesh";
    scene::MeshLevels levels = *node.levels;
    for (scene::MeshLevel& level : levels) {
        level.error = 0.0;
        level.shaded_width = 0.0;
        level.repeat = 3.0;
    }
    node.levels = std::make_shared<const scene::MeshLevels>(levels);
    EXPECT_EQ(world.seen_from(1000.0).list.meshes.front().level, 0U) << "0.7 pixels";
    EXPECT_EQ(world.seen_from(2000.0).list.meshes.front().level, levels.size()) << "0.3 pixels";
    levels.back().repeat = 0.0;
    node.levels = std::make_shared<const scene::MeshLevels>(levels);
    EXPECT_EQ(world.seen_from(100.0).list.meshes.front().level, levels.size());
    node.material.detail.offset = -0.5F; // relief
    EXPECT_EQ(world.seen_from(2000.0).list.meshes.front().level, 0U);
}

TEST(MeshLevelsInViews, OfAnOrthographicCameraDependOnItsScaleOnly) {
    StatueScene world;
    auto& camera = *world.camera->get<scene::Camera>();
    camera.projection = scene::ProjectionKind::orthographic;
    camera.view_height = 10'000.0;
    const std::size_t far = world.seen_from(1e5).list.meshes.front().level;
    EXPECT_GT(far, 0U);
    EXPECT_EQ(world.seen_from(20.0).list.meshes.front().level, far);
}

} // namespace
} // namespace reljef::view
