#include "app/viewer/appearance_switch.h"

#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/made_hill.h"
#include "tests/support/process_state.h"
#include "tests/support/temporary_folder.h"

namespace reljef::app {
namespace {

scene::Technique technique(const char* text) {
    return scene::parse_technique(text).value();
}

class AppearanceSwitchTest : public testing::Test {
protected:
    [[nodiscard]] const scene::Technique& shown() const {
        return scene_.terrain->get<scene::TerrainNode>()->material.technique;
    }
    // How often the scene changed meanwhile.
    int wait(AppearanceSwitch& tested) {
        int changes = 0;
        while (tested.is_preparing()) {
            changes += tested.update() ? 1 : 0;
            std::this_thread::yield();
        }
        return changes;
    }

    test::TemporaryFolder folder_;
    test::EnvironmentVariable cache_{"XDG_CACHE_HOME", folder_.path().string()};
    session::TerrainScene scene_ = hill_scene();
};

TEST_F(AppearanceSwitchTest, ShowsATechniqueThatNeedsNoMapsAtOnce) {
    AppearanceSwitch tested(scene_);
    tested.request(technique("texture"));
    EXPECT_EQ(shown(), technique("texture"));
    EXPECT_FALSE(tested.is_preparing());
    EXPECT_FALSE(tested.update());
}

TEST_F(AppearanceSwitchTest, KeepsTheTechniqueUntilTheMapsAreThere) {
    for (const char* const text : {"cone", "polygons:error=1"}) {
        AppearanceSwitch tested(scene_);
        tested.request(technique("texture"));
        tested.request(technique(text));
        EXPECT_EQ(shown(), technique("texture")) << text;
        EXPECT_EQ(tested.technique(), technique(text));
        EXPECT_EQ(wait(tested), 1) << text;
        EXPECT_EQ(shown(), technique(text));
        EXPECT_TRUE(session::missing_maps(scene_, technique(text)).empty()) << text;
        tested.request(technique("texture"));
        tested.request(technique(text));
        EXPECT_EQ(shown(), technique(text)) << "the maps are there";
    }
}

TEST_F(AppearanceSwitchTest, ALaterRequestReplacesTheOneUnderWay) {
    AppearanceSwitch tested(scene_);
    tested.request(technique("cone"));
    tested.request(technique("relief"));
    EXPECT_EQ(shown(), technique("relief"));
    EXPECT_EQ(wait(tested), 0);
    for (int i = 0; i < 100; ++i) {
        EXPECT_FALSE(tested.update());
    }
    EXPECT_EQ(shown(), technique("relief"));
}

TEST_F(AppearanceSwitchTest, EndsWhileMapsAreMade) {
    AppearanceSwitch tested(scene_);
    tested.request(technique("cone"));
}

} // namespace
} // namespace reljef::app
