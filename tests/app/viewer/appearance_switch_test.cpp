#include "app/viewer/appearance/appearance_switch.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/cache/disk_cache.h"
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
            std::this_thread::sleep_for(
                std::chrono::milliseconds(1)); // leaves the work a processor
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

TEST_F(AppearanceSwitchTest, KeepsTheLightUntilItsMapsAreThere) {
    AppearanceSwitch tested(scene_);
    tested.request(technique("cone"));
    const scene::Light before = *scene_.light->get<scene::Light>();
    scene::Light light = before;
    light.azimuth += 15.0;
    tested.request(light);
    EXPECT_EQ(*scene_.light->get<scene::Light>(), before);
    EXPECT_EQ(tested.light(), light);
    EXPECT_EQ(tested.technique(), technique("cone")) << "both were requested";
    EXPECT_EQ(wait(tested), 1);
    EXPECT_EQ(*scene_.light->get<scene::Light>(), light);
    EXPECT_EQ(shown(), technique("cone"));
    const auto made = tested.take_light();
    ASSERT_NE(made, nullptr);
    EXPECT_EQ(made->request.light.sun, light);
    EXPECT_EQ(made->lit.cols(), made->request.surface->heightfield().heights.cols());
    EXPECT_EQ(tested.take_light(), nullptr) << "once";
}

TEST_F(AppearanceSwitchTest, GoesBackFromATechniqueThatCannotBeDrawn) {
    AppearanceSwitch tested(scene_);
    EXPECT_FALSE(tested.undo());
    const scene::Technique before = shown();
    tested.request(technique("texture"));
    EXPECT_TRUE(tested.undo());
    EXPECT_EQ(shown(), before);
    EXPECT_FALSE(tested.undo());
}

TEST_F(AppearanceSwitchTest, HandsOnWhatFinishedWorkReported) {
    const auto& heights = scene_.terrain->get<scene::TerrainNode>()->surface->heightfield().heights;
    const Grid<float> unit_heights = terrain::unit_heights(heights.view());
    const auto file = io::cone_file(io::cache_folder().value(), unit_heights.view());
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << "no cones";
    AppearanceSwitch tested(scene_);
    tested.request(technique("cone"));
    wait(tested);
    struct Collected : session::Log {
        void message(session::MessageKind /*kind*/, std::string_view sentence) override {
            notes.emplace_back(sentence);
        }
        std::vector<std::string> notes;
    } collected;
    tested.relay_to(collected);
    EXPECT_THAT(collected.notes,
                testing::ElementsAre(testing::HasSubstr(file.filename().string())));
}

TEST_F(AppearanceSwitchTest, EndsWhileMapsAreMade) {
    AppearanceSwitch tested(scene_);
    tested.request(technique("cone"));
}

} // namespace
} // namespace reljef::app
