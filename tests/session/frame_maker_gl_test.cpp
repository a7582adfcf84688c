#include "engine/session/frame_maker.h"

#include <gtest/gtest.h>

#include "tests/app/made_hill.h"

namespace reljef::session {
namespace {

constexpr glm::ivec2 picture{64, 48};

Device osmesa_device() {
    return std::move(
        *Device::create({.context = platform::ContextKind::osmesa, .size = picture}));
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
