#include "engine/view/picture/eye_dome.h"

#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/view/select.h"
#include "tests/render/made_scene.h"

namespace reljef::view {
namespace {

constexpr glm::ivec2 domed_picture{96, 72};
constexpr Rgba8 pale{200, 180, 160, 255};

DrawList list_of(const scene::Camera& camera, double strength = 1.0) {
    DrawList list;
    list.camera = camera;
    list.size = domed_picture;
    list.eye_dome = strength;
    return list;
}

// What rays see of a plane through a point; behind the eye, and where it is parallel: sky.
Grid<float> depths_of_plane(const scene::Camera& camera, glm::dvec3 point, glm::dvec3 normal) {
    Grid<float> depths(domed_picture.x, domed_picture.y, std::numeric_limits<float>::infinity());
    for (int row = 0; row < domed_picture.y; ++row) {
        for (int col = 0; col < domed_picture.x; ++col) {
            const Ray ray = scene::view_ray(camera, domed_picture, {col + 0.5, row + 0.5});
            const double along = glm::dot(ray.direction, normal);
            const double t = along != 0.0 ? glm::dot(point - ray.origin, normal) / along : -1.0;
            if (t > 0.0) {
                depths(col, row) = static_cast<float>(t);
            }
        }
    }
    return depths;
}

Image shaded(const Grid<float>& depths, const DrawList& list) {
    Image picture(depths.cols(), depths.rows(), pale);
    shade_eye_dome(picture.view(), depths, list);
    return picture;
}

scene::Camera level_map() {
    scene::Camera map = test::camera_at({0.0, 0.0, 500.0}, {0.0, 0.0, 0.0});
    map.projection = scene::ProjectionKind::orthographic;
    map.view_height = 100.0;
    return map;
}

TEST(EyeDome, PlanesKeepTheirColourAtAnyAngle) {
    std::mt19937 random(4);
    std::normal_distribution<double> any;
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 normal = glm::normalize(glm::dvec3(any(random), any(random), any(random)));
        scene::Camera camera = test::camera_at({0.0, -100.0, 30.0}, {0.0, 0.0, 0.0});
        if (i % 2 == 1) {
            camera.projection = scene::ProjectionKind::orthographic;
            camera.view_height = 80.0;
        }
        const Grid<float> depths = depths_of_plane(camera, {0.0, 0.0, 0.0}, normal);
        const Image picture = shaded(depths, list_of(camera));
        for (const Rgba8 color : picture.samples()) {
            ASSERT_EQ(color, pale) << i;
        }
    }
}

// Ground beside a higher plateau: dark at its foot, as before elsewhere and above.
TEST(EyeDome, TheFootOfAStepIsDark) {
    const scene::Camera map = level_map();
    Grid<float> depths = depths_of_plane(map, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
    constexpr int edge = 48;
    for (int row = 0; row < domed_picture.y; ++row) {
        for (int col = edge; col < domed_picture.x; ++col) {
            depths(col, row) -= 50.0F;
        }
    }
    for (const double strength : {0.5, 1.0}) {
        const Image picture = shaded(depths, list_of(map, strength));
        const auto at = [&](int col) { return picture(col, domed_picture.y / 2).r; };
        EXPECT_LT(at(edge - 1), pale.r * (1.0 - 0.6 * strength));
        EXPECT_GE(at(edge - 1), pale.r * (1.0 - strength));
        EXPECT_LE(at(edge - 1), at(edge - 3));
        EXPECT_LE(at(edge - 3), at(edge - 6));
        EXPECT_EQ(at(edge - 12), pale.r);
        EXPECT_EQ(at(edge), pale.r);
    }
}

TEST(EyeDome, TheSkyKeepsItsColour) {
    const scene::Camera camera = test::camera_at({0.0, -100.0, 3.0}, {0.0, 0.0, 3.0});
    const Grid<float> depths = depths_of_plane(camera, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
    const Image picture = shaded(depths, list_of(camera));
    for (int col = 0; col < domed_picture.x; ++col) {
        EXPECT_EQ(picture(col, 0), pale);
        EXPECT_EQ(picture(col, domed_picture.y / 2 - 1), pale);
    }
}

TEST(EyeDome, IsSelectedUnlessATerrainHidesItsOverlay) {
    scene::Scene scene;
    auto& terrain = *test::add_terrain(scene, test::plane_heightfield(Grid<float>(3, 3, 0.0F)))
                         .get<scene::TerrainNode>();
    SceneView view(scene, domed_picture);
    EXPECT_EQ(select(view).list.eye_dome, 0.0);
    scene.set_eye_dome(0.5);
    EXPECT_TRUE(view.look(scene, domed_picture));
    EXPECT_EQ(select(view).list.eye_dome, 0.5);
    terrain.hides_overlay = true;
    EXPECT_TRUE(view.look(scene, domed_picture));
    EXPECT_EQ(select(view).list.eye_dome, 0.0);
}

} // namespace
} // namespace reljef::view
