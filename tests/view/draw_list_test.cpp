#include "engine/view/select.h"

#include <random>
#include <set>
#include <utility>

#include <glm/ext/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "tests/render/made_scene.h"

namespace reljef::render {
namespace {

constexpr glm::ivec2 picture_size{320, 240};

class Chance {
public:
    explicit Chance(unsigned seed) : random_(seed) {}
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    scene::Camera camera(double reach) {
        scene::Camera camera;
        camera.eye = {between(-reach, reach), between(-reach, reach), between(-0.1, 0.6) * reach};
        camera.target =
            camera.eye + glm::dvec3(between(-1.0, 1.0), between(-1.0, 1.0), between(-1.0, 0.3));
        camera.vertical_fov = between(0.0, 1.0) < 0.2 ? between(0.01, 2.0) : between(10.0, 120.0);
        if (between(0.0, 1.0) < 0.3) {
            camera.projection = scene::ProjectionKind::orthographic;
            camera.view_height = between(0.01, 0.8) * reach;
        }
        return camera;
    }

private:
    std::mt19937 random_;
};

bool shows(const scene::Camera& camera, glm::dvec3 world) {
    const auto at = scene::project(camera, picture_size, world);
    const bool perspective = camera.projection == scene::ProjectionKind::perspective;
    return (!perspective || at.depth > camera.near) && at.pixel.x >= 0.0 && at.pixel.y >= 0.0 &&
           at.pixel.x <= picture_size.x && at.pixel.y <= picture_size.y;
}

bool shows_a_sample(const scene::Camera& camera, const scene::Node& node,
                    const terrain::TileCells& tile, bool flat) {
    const auto& surface = test::surface_of(node);
    const glm::dmat4 world_from_local = node.world_from_local();
    const double reference = terrain::reference_height(surface.heightfield());
    for (int row = tile.first.y; row <= tile.last().y; row += 4) {
        for (int col = tile.first.x; col <= tile.last().x; col += 4) {
            const double height = flat ? reference : surface.heightfield().heights(col, row);
            const glm::dvec3 local = surface.placement().world_from_sample({col, row, height});
            if (shows(camera, glm::dvec3(world_from_local * glm::dvec4(local, 1.0)))) {
                return true;
            }
        }
    }
    return false;
}

std::size_t triangles_of(const scene::Node& node) {
    const auto& heights = test::surface_of(node).heightfield().heights;
    return 2U * static_cast<std::size_t>(heights.cols() - 1) *
           static_cast<std::size_t>(heights.rows() - 1);
}

void expect_right_selection(scene::Scene& scene, const scene::Node& node, bool flat) {
    const view::DrawList list = view::select(scene, picture_size).list;
    const auto& surface = test::surface_of(node);
    std::set<const scene::TerrainTile*> drawn;
    std::size_t triangles = 0;
    double nearest = 0.0;
    for (const view::TileDraw& draw : list.tiles) {
        ASSERT_GE(draw.distance, nearest) << "front to back";
        nearest = draw.distance;
        ASSERT_TRUE(drawn.insert(draw.tile.get()).second);
        ASSERT_EQ(draw.flat, flat);
        triangles += 2U * static_cast<std::size_t>(draw.tile->cells.x * draw.tile->cells.y);
    }
    const auto& skipped = list.stats.skipped;
    ASSERT_EQ(list.tiles.size() + static_cast<std::size_t>(skipped.tiles_outside_frustum),
              surface.tiles().size());
    ASSERT_EQ(skipped.nodes_outside_frustum, list.tiles.empty() ? 1 : 0);
    if (!flat) {
        ASSERT_EQ(triangles + skipped.triangles_outside_frustum, triangles_of(node));
    }
    for (std::size_t i = 0; i < surface.tiles().size(); ++i) {
        const scene::TerrainTile& tile = *surface.tiles()[i];
        if (!drawn.contains(&tile)) {
            ASSERT_FALSE(
                shows_a_sample(list.camera, node, terrain::TileCells{tile.first, tile.cells}, flat))
                << "tile " << i;
        }
    }
}

TEST(DrawList, NeverDropsATileThatShows) {
    Chance chance(1);
    scene::Scene scene;
    scene::Node& terrain =
        test::add_terrain(scene, test::plane_heightfield(test::hills(500, 400, 60.0), {3.0, 4.0}));
    scene::Node& camera = scene.add_camera();
    for (int i = 0; i < 300; ++i) {
        *camera.get<scene::Camera>() = chance.camera(1500.0);
        expect_right_selection(scene, terrain, false);
        if (HasFatalFailure()) {
            FAIL() << "camera " << i;
        }
    }
}

TEST(DrawList, NeverDropsATileThatShowsOfARotatedNode) {
    Chance chance(2);
    scene::Scene scene;
    scene::Node& terrain =
        test::add_terrain(scene, test::plane_heightfield(test::hills(400, 300, 60.0), {3.0, 4.0}));
    scene::Node& camera = scene.add_camera();
    for (int i = 0; i < 150; ++i) {
        terrain.set_parent_from_local(
            glm::rotate(glm::translate(glm::dmat4(1.0), {100.0, 50.0, -20.0}),
                        chance.between(-3.0, 3.0), {chance.between(-0.3, 0.3), 0.1, 1.0}));
        *camera.get<scene::Camera>() = chance.camera(1500.0);
        expect_right_selection(scene, terrain, false);
        if (HasFatalFailure()) {
            FAIL() << "camera " << i;
        }
    }
}

TEST(DrawList, NeverDropsAFlatTileThatShowsOnAnEllipsoid) {
    Chance chance(3);
    scene::Scene scene;
    // High in the middle only: the flat reference lies above the ground at the border.
    scene::Node& terrain = test::add_terrain(
        scene, test::geographic_heightfield(
                   test::made_heights(400, 300,
                                      [](int col, int row) {
                                          return std::hypot(col - 200, row - 150) < 20.0 ? 8000.0
                                                                                         : 0.0;
                                      }),
                   46.0, 7.0, 0.005));
    terrain.get<scene::TerrainNode>()->material.technique =
        scene::make_technique(scene::TechniqueId::texture);
    scene::Node& camera = scene.add_camera();
    for (int i = 0; i < 150; ++i) {
        *camera.get<scene::Camera>() = chance.camera(1.2e5);
        expect_right_selection(scene, terrain, true);
        if (HasFatalFailure()) {
            FAIL() << "camera " << i;
        }
    }
}

// Each terrain is one entry, whether rays search it or its tiles are triangles.
TEST(DrawList, ListsEachTerrainOnceAndSearchedOnesFrontToBack) {
    scene::Scene scene;
    const auto add = [&](double north, scene::TechniqueId technique) {
        scene::Node& node = test::add_terrain(
            scene, test::plane_heightfield(test::hills(40, 40, 60.0), {3.0, 4.0}));
        node.get<scene::TerrainNode>()->material.technique = scene::make_technique(technique);
        node.set_position({0.0, north, 0.0});
        return node.get<scene::TerrainNode>();
    };
    const auto* const far = add(1000.0, scene::TechniqueId::relief);
    const auto* const triangles = add(500.0, scene::TechniqueId::polygons);
    const auto* const near = add(200.0, scene::TechniqueId::exact);
    scene.add_camera(test::camera_at({0.0, 0.0, 100.0}, {0.0, 500.0, 0.0}));
    const view::DrawList list = view::select(scene, picture_size).list;
    ASSERT_EQ(list.terrains.size(), 3U);
    const auto searched = view::searched_terrains(list);
    ASSERT_EQ(searched.size(), 2U);
    EXPECT_EQ(searched.front()->terrain, near);
    EXPECT_EQ(searched.back()->terrain, far);
    ASSERT_FALSE(list.tiles.empty());
    for (const view::TileDraw& draw : list.tiles) {
        EXPECT_EQ(draw.terrain, triangles);
        EXPECT_EQ(list.terrains[draw.node].terrain, triangles);
    }
}

TEST(DrawList, CountsWhatIsHidden) {
    scene::Scene scene;
    scene::Node& group = scene.root().add("group");
    group.add("one");
    group.add("two");
    scene.add_camera();
    const view::DrawList all = view::select(scene, picture_size).list;
    EXPECT_EQ(all.stats.nodes, 5);
    EXPECT_EQ(all.stats.skipped.invisible_nodes, 0);
    group.set_visible(false);
    const view::DrawList some = view::select(scene, picture_size).list;
    EXPECT_EQ(some.stats.nodes, 5);
    EXPECT_EQ(some.stats.skipped.invisible_nodes, 3);
}

TEST(DrawList, HoldsTheFirstVisibleLightAndTheSky) {
    scene::Scene scene;
    EXPECT_FALSE(view::select(scene, picture_size).list.sun);
    EXPECT_FALSE(view::select(scene, picture_size).list.sky);
    EXPECT_EQ(view::select(scene, picture_size).list.stats.skipped.sky, 1);
    scene::Node& first = scene.add_light({.azimuth = 1.0});
    scene.add_light({.azimuth = 2.0});
    scene.set_sky({});
    EXPECT_EQ(view::select(scene, picture_size).list.sun->azimuth, 1.0);
    first.set_visible(false);
    EXPECT_EQ(view::select(scene, picture_size).list.sun->azimuth, 2.0);
    EXPECT_TRUE(view::select(scene, picture_size).list.sky);
    EXPECT_EQ(view::select(scene, picture_size).list.stats.skipped.sky, 0);
}

TEST(DrawList, LeavesOutMeshesOutsideTheFrustum) {
    scene::Scene scene;
    scene.add_camera(test::camera_at({0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}));
    scene::Node& box = scene.add_mesh(scene::box_mesh(glm::vec3(1.0F)));
    box.set_position({0.0, 5.0, 0.0});
    EXPECT_EQ(view::select(scene, picture_size).list.meshes.size(), 1U);
    box.set_position({0.0, -5.0, 0.0});
    EXPECT_TRUE(view::select(scene, picture_size).list.meshes.empty());
    EXPECT_EQ(view::select(scene, picture_size).list.stats.skipped.nodes_outside_frustum, 1);
    EXPECT_EQ(view::select(scene, picture_size).list.stats.skipped.triangles_outside_frustum, 12U);
}

TEST(DrawList, FitsTheDepthOfAnOrthographicCameraToTheScene) {
    Chance chance(4);
    scene::Scene scene;
    scene::Node& terrain =
        test::add_terrain(scene, test::plane_heightfield(test::hills(60, 50, 60.0), {30.0, 40.0}));
    terrain.set_position({1e5, 2e5, 300.0});
    scene::Node& node = scene.add_camera();
    for (int i = 0; i < 100; ++i) {
        scene::Camera camera = chance.camera(5e3);
        camera.projection = scene::ProjectionKind::orthographic;
        *node.get<scene::Camera>() = camera;
        const view::DrawList list = view::select(scene, picture_size).list;
        const Box bounds = scene.root().world_bounds();
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 at{(corner & 1) != 0 ? bounds.low.x : bounds.high.x,
                                (corner & 2) != 0 ? bounds.low.y : bounds.high.y,
                                (corner & 4) != 0 ? bounds.low.z : bounds.high.z};
            const double depth = scene::project(list.camera, picture_size, at).depth;
            ASSERT_GT(depth, list.camera.orthographic_near);
            ASSERT_LT(depth, list.camera.orthographic_far);
        }
    }
}

} // namespace
} // namespace reljef::render
