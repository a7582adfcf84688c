#include "engine/render/shaders/sun_maps.h"

#include <algorithm>
#include <memory>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/view/select.h"
#include "tests/render/made_scene.h"
#include "tests/scene/streaming/streamed_samples.h"

namespace reljef::render {
namespace {

constexpr int map_side = 1024;
constexpr glm::ivec2 sun_picture{400, 300};

// A plain with 40 boxes, some beside the picture.
struct BoxesInTheSun {
    scene::Scene scene;
    scene::Light sun;
    scene::Node* ground = nullptr;
    std::mt19937 random{5};

    BoxesInTheSun() {
        ground = &test::add_terrain(
            scene, test::plane_heightfield(Grid<float>(65, 65, 2.0F), {50.0, 50.0}), {},
            {.placement = terrain::PlacementKind::plane});
        set_shadow(true);
        sun.azimuth = 230.0;
        sun.altitude = 25.0;
        scene.add_light(sun);
        const auto box = std::make_shared<const scene::Mesh>(scene::box_mesh({8.0F, 6.0F, 30.0F}));
        for (int i = 0; i < 40; ++i) {
            scene.root()
                .add("box", scene::MeshNode{box, {}})
                .set_position({any(-700.0, 700.0), any(-700.0, 700.0), 10.0});
        }
        look({0.0, -800.0, 60.0}, {0.0, 0.0, 0.0});
    }
    double any(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    }
    void set_shadow(bool on) {
        scene::Technique technique{scene::Exact{}};
        if (on) {
            technique.options.shadow = scene::Shadow{.depth = 0.0};
        }
        ground->get<scene::TerrainNode>()->material.technique = technique;
    }
    void look(glm::dvec3 eye, glm::dvec3 target) {
        scene::Node& node = scene.add_camera({.eye = eye, .target = target});
        scene.set_active_camera(node);
    }
    [[nodiscard]] view::DrawList list() const { return view::select(scene, sun_picture).list; }
};

glm::dvec3 on_map(const SunMap& map, glm::dvec3 relative) {
    return glm::dvec3(map.map_from_relative * glm::dvec4(relative, 1.0));
}

bool is_on(glm::dvec3 at) {
    return at.x > 0.0 && at.y > 0.0 && at.x < 1.0 && at.y < 1.0;
}

TEST(SunMaps, ShowEachSeenPlaceInTheShadowOfAMesh) {
    BoxesInTheSun stage;
    for (const glm::dvec3 eye : {glm::dvec3(0.0, -800.0, 60.0), glm::dvec3(10.0, 20.0, 4.0),
                                 glm::dvec3(300.0, 300.0, 900.0)}) {
        stage.look(eye, {40.0, 50.0, 0.0});
        const view::DrawList list = stage.list();
        const auto maps = sun_maps(list, map_side);
        ASSERT_FALSE(maps.empty());
        int seen = 0;
        for (const view::MeshDraw& draw : shadow_casters(list)) {
            for (int i = 0; i < 200; ++i) {
                const glm::dvec3 corner(draw.world_from_local *
                                        glm::dvec4(stage.any(-4.0, 4.0), stage.any(-3.0, 3.0),
                                                   stage.any(-15.0, 15.0), 1.0));
                const glm::dvec3 shaded = corner - stage.any(0.0, 1.0) * (corner.z - 2.0) /
                                                       scene::to_light(stage.sun).z *
                                                       scene::to_light(stage.sun);
                const auto at = scene::project(list.camera, list.size, shaded);
                const bool is_seen = at.depth > list.camera.near && at.pixel.x > 0.0 &&
                                     at.pixel.y > 0.0 && at.pixel.x < list.size.x &&
                                     at.pixel.y < list.size.y;
                if (!is_seen || corner.z < 2.0) {
                    continue;
                }
                ++seen;
                const auto first = std::find_if(maps.begin(), maps.end(), [&](const SunMap& map) {
                    return is_on(on_map(map, shaded - list.camera.eye));
                });
                ASSERT_NE(first, maps.end());
                // The caster is at the same place of the map, nearer to the sun.
                const glm::dvec3 place = on_map(*first, shaded - list.camera.eye);
                const glm::dvec3 caster = on_map(*first, corner - list.camera.eye);
                ASSERT_NEAR(place.x, caster.x, 1e-9);
                ASSERT_NEAR(place.y, caster.y, 1e-9);
                ASSERT_GE(caster.z, place.z);
                ASSERT_TRUE(caster.z > 0.0 && caster.z < 1.0);
                // Texels are a few pixels wide at most.
                const double pixel = scene::metres_a_pixel(list.camera, list.size).y * at.depth;
                ASSERT_LE(first->texel, 12.0 * pixel + 0.01) << at.depth;
            }
        }
        EXPECT_GT(seen, 500);
    }
}

TEST(SunMaps, AreThoseOfTheWholePictureInEachPart) {
    BoxesInTheSun stage;
    const auto whole = sun_maps(stage.list(), map_side);
    const scene::Camera camera = stage.scene.camera();
    const scene::Camera part = scene::part_camera(camera, sun_picture, {{200, 150}, {100, 80}});
    scene::Node& node = stage.scene.add_camera(part);
    stage.scene.set_active_camera(node);
    const auto of_part = sun_maps(view::select(stage.scene, {100, 80}).list, map_side);
    ASSERT_EQ(whole.size(), of_part.size());
    for (std::size_t i = 0; i < whole.size(); ++i) {
        EXPECT_EQ(whole[i].map_from_relative, of_part[i].map_from_relative);
        EXPECT_EQ(whole[i].texel, of_part[i].texel);
    }
}

TEST(SunMaps, AreNoneWhereNothingCastsShadows) {
    BoxesInTheSun stage;
    EXPECT_FALSE(sun_maps(stage.list(), map_side).empty());
    stage.set_shadow(false);
    EXPECT_TRUE(sun_maps(stage.list(), map_side).empty()) << "without the option";
    stage.set_shadow(true);
    stage.look({0.0, -800.0, 60.0}, {0.0, -1600.0, 860.0});
    EXPECT_TRUE(sun_maps(stage.list(), map_side).empty()) << "beside the picture";
    stage.look({0.0, -800.0, 60.0}, {0.0, 0.0, 0.0});
    view::DrawList list = stage.list();
    list.sun->altitude = -1.0;
    EXPECT_TRUE(sun_maps(list, map_side).empty()) << "at night";
    list = stage.list();
    list.meshes.clear();
    list.meshes_beside.clear();
    EXPECT_TRUE(sun_maps(list, map_side).empty()) << "without meshes";
}

} // namespace
} // namespace reljef::render
