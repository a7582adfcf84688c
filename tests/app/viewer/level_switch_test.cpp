#include "app/viewer/appearance/level_switch.h"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "tests/io/mesh/made_mesh.h"
#include "tests/session/made_session.h"
#include "tests/support/temporary_folder.h"

namespace reljef::app {
namespace {

class LevelSwitchTest : public testing::Test {
protected:
    [[nodiscard]] session::TerrainScene open(const scene::Technique& technique) const {
        session::SourceOptions source;
        source.terrain = dem_;
        session::SceneOptions view;
        view.technique = technique;
        view.prepares_maps = false;
        view.objects = {{ball_, glm::dvec2(1.0, 2.0)}};
        session::Log silent;
        auto scene = session::open_scene(source, view, silent);
        EXPECT_TRUE(scene) << (scene ? "" : scene.error().message);
        return std::move(*scene);
    }
    static scene::Technique bounded() { return {scene::Polygons{.max_levels = 1, .error = 1.0}}; }
    static bool has_levels(const session::TerrainScene& scene) {
        return scene.objects.front().node->children().front()->get<scene::MeshNode>()->levels !=
               nullptr;
    }
    // Whether the scene changed within a minute.
    static bool has_changed(LevelSwitch& tested) {
        for (int i = 0; i < 30'000; ++i) {
            if (tested.update()) {
                return true;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return false;
    }

    test::TemporaryFolder folder_;
    std::string dem_ = folder_
                           .write("dem.asc", "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\n"
                                             "cellsize 900\n0 0 0\n0 0 0\n0 0 0\n")
                           .string();
    std::filesystem::path ball_ = folder_.write("ball.obj", test::ball_obj(40));
};

TEST_F(LevelSwitchTest, ShowsTheLevelsOnceTheyAreMade) {
    session::TerrainScene scene = open(bounded());
    LevelSwitch tested(scene);
    EXPECT_FALSE(has_levels(scene));
    EXPECT_TRUE(has_changed(tested));
    EXPECT_TRUE(has_levels(scene));
    EXPECT_FALSE(tested.update()) << "once";
}

TEST_F(LevelSwitchTest, WaitsForATechniqueWithAnErrorBound) {
    session::TerrainScene scene = open(scene::make_technique(scene::TechniqueId::exact));
    LevelSwitch tested(scene);
    for (int i = 0; i < 10; ++i) {
        EXPECT_FALSE(tested.update());
        EXPECT_TRUE(tested.progress().label.empty());
    }
    scene.terrain->get<scene::TerrainNode>()->material.technique = bounded();
    EXPECT_TRUE(has_changed(tested));
    EXPECT_TRUE(has_levels(scene));
}

TEST_F(LevelSwitchTest, StopsWithTheViewer) {
    session::TerrainScene scene = open(bounded());
    {
        LevelSwitch tested(scene);
        tested.update();
    }
    EXPECT_FALSE(has_levels(scene));
}

} // namespace
} // namespace reljef::app
