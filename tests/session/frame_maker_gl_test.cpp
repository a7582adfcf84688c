#include "engine/session/frame_maker.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "engine/session/prepared_maps.h"
#include "tests/app/made_hill.h"

namespace reljef::session {
namespace {

constexpr glm::ivec2 picture{64, 48};

Device osmesa_device() {
    return std::move(*Device::create({.context = platform::ContextKind::osmesa, .size = picture}));
}

TEST(DeviceFramesGl, SelectEachViewOnce) {
    TerrainScene scene = app::hill_scene();
    Log silent;
    DeviceFrames frames(osmesa_device(), silent);
    auto& camera = *scene.camera->get<scene::Camera>();
    for (int frame = 1; frame <= 10; ++frame) {
        camera.eye.x += 1.0;
        frames.wait_for_tiles(scene.scene, {});
        ASSERT_TRUE(frames.draw(scene.scene, {}));
        EXPECT_EQ(frames.selections(), frame);
    }
    ASSERT_TRUE(frames.draw_hits(scene.scene, {}));
    ASSERT_TRUE(frames.draw(scene.scene, {}));
    EXPECT_EQ(frames.selections(), 10) << "nothing changed since";
}

// It is drawn as it is, which shows that drawing makes no light of its own.
TEST(SceneRendererGl, DrawsWithTheLightThatWasPrepared) {
    const TerrainScene scene = app::hill_scene();
    const scene::Technique& technique =
        scene.terrain->get<scene::TerrainNode>()->material.technique;
    for (const bool in_parts : {false, true}) {
        Device device = osmesa_device();
        SceneRenderer& renderer = device.renderer();
        scene::Technique drawn = technique;
        if (in_parts) {
            drawn = scene::parse_technique("relief:shadow=hard").value();
        }
        scene.terrain->get<scene::TerrainNode>()->material.technique = drawn;
        const auto request = light_request(scene, *scene.light->get<scene::Light>(), drawn,
                                           renderer.max_texture_side());
        ASSERT_TRUE(request);
        render::PreparedLight light = render::prepare_light(*request);
        std::fill(light.lit.samples().begin(), light.lit.samples().end(), Rgba8{255, 0, 0, 255});
        std::fill(light.sun.samples().begin(), light.sun.samples().end(), Rgba8{0, 0, 0, 255});
        ASSERT_TRUE(renderer.add_light(light));
        ASSERT_TRUE(renderer.draw(scene.scene, true));
        const Image image = renderer.read_color();
        const Rgba8 middle = image(image.cols() / 2, image.rows() / 2);
        EXPECT_GT(middle.r, 2 * middle.g) << in_parts << ", seen through air";
    }
}

// Ctrl-C may come before any view was selected.
TEST(DeviceFramesGl, DrawAFrameThatIsStoppedBeforeItBegins) {
    const TerrainScene scene = app::hill_scene();
    Log silent;
    DeviceFrames frames(osmesa_device(), silent);
    std::stop_source stop;
    stop.request_stop();
    ParallelOptions parallel;
    parallel.stop = stop.get_token();
    EXPECT_TRUE(frames.draw_hits(scene.scene, parallel));
    EXPECT_TRUE(frames.draw(scene.scene, parallel));
}

} // namespace
} // namespace reljef::session
