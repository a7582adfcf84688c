#include <vector>

#include <gtest/gtest.h>

#include "app/viewer/viewer.h"
#include "tests/app/made_hill.h"

namespace reljef::app {
namespace {

struct ViewerActions : testing::Test {
    void press(Key key) {
        viewer.receive(KeyEvent{.key = key, .pressed = true});
        viewer.receive(KeyEvent{.key = key, .pressed = false});
    }

    session::TerrainScene scene = hill_scene();
    Viewer viewer{scene, scene::orbit_path(scene.bounds, 10.0), {400, 300}};
};

TEST_F(ViewerActions, ActionsEditThePath) {
    const auto times = [&] {
        std::vector<double> found;
        for (const scene::Keyframe& key : viewer.path_desk().path().keys()) {
            found.push_back(key.time - viewer.path_desk().path().begin());
        }
        return found;
    };
    press(Key::insert);
    press(Key::insert);
    ASSERT_EQ(times(), (std::vector{0.0, 3.0}));
    ASSERT_TRUE(viewer.act(InsertPathKey{1.0}));
    EXPECT_EQ(times(), (std::vector{0.0, 1.0, 3.0}));
    ASSERT_TRUE(viewer.act(RetimePathKey{1, 2.0}));
    EXPECT_EQ(times(), (std::vector{0.0, 2.0, 3.0}));
    EXPECT_FALSE(viewer.act(RetimePathKey{1, 3.0})); // another one is there
    ASSERT_TRUE(viewer.act(SetPathDuration{6.0}));
    EXPECT_EQ(times(), (std::vector{0.0, 4.0, 6.0}));
    ASSERT_TRUE(viewer.act(SeekPath{6.0}));
    ASSERT_TRUE(viewer.act(MovePathKey{0}));
    ASSERT_TRUE(viewer.act(RemovePathKey{2}));
    EXPECT_EQ(times(), (std::vector{0.0, 4.0}));
    EXPECT_LE(viewer.path_time(), 4.0);
    EXPECT_TRUE(viewer.take_content_change());
    ASSERT_TRUE(viewer.act(RemovePathKey{1}));
    EXPECT_FALSE(viewer.act(RemovePathKey{0})); // the only one
    EXPECT_FALSE(viewer.act(MovePathKey{7}));
}

TEST_F(ViewerActions, SpaceComparesAndSwapsTechniques) {
    press(Key::space);
    EXPECT_EQ(viewer.comparison().with(), CompareWith::truth);
    press(Key::minus);
    EXPECT_NEAR(viewer.comparison().share(), 0.45, 1e-12);
    ASSERT_TRUE(viewer.act(SetOtherTechnique{scene::Technique{scene::Texture{}}}));
    const scene::Technique left = viewer.technique();
    ASSERT_TRUE(viewer.act(SwapTechniques{}));
    EXPECT_EQ(viewer.technique().id(), scene::TechniqueId::texture);
    EXPECT_EQ(viewer.comparison().technique(), left);
    press(Key::space);
    EXPECT_FALSE(viewer.comparison().is_on());
}

} // namespace
} // namespace reljef::app
