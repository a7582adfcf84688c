#include "app/viewer/appearance/proof_switch.h"

#include <filesystem>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/viewer/viewer.h"
#include "engine/session/streaming.h"
#include "engine/session/terrain_index.h"
#include "tests/session/made_session.h"
#include "tests/session/made_waves.h"
#include "tests/support/process_state.h"
#include "tests/support/temporary_folder.h"

namespace reljef::app {
namespace {

constexpr glm::ivec2 size{160, 120};

class ProofSwitchTest : public testing::Test {
protected:
    void SetUp() override { test::write_waves(folder_.path() / "waves.tif", 2300, 600); }
    [[nodiscard]] session::TerrainScene open() const {
        session::SourceOptions choice;
        choice.terrain = (folder_.path() / "waves.tif").string();
        choice.memory_megabytes = 8;
        choice.streamed = true;
        choice.index = session::IndexUse::existing;
        session::Log silent;
        auto scene = session::open_scene(choice, {}, silent);
        EXPECT_TRUE(scene) << (scene ? "" : scene.error().message);
        return std::move(*scene);
    }
    static const std::shared_ptr<scene::TileStream>& stream_of(const session::TerrainScene& scene) {
        return scene.terrain->get<scene::TerrainNode>()->stream;
    }

    test::TemporaryFolder folder_;
    test::EnvironmentVariable cache_{"XDG_CACHE_HOME", (folder_.path() / "cache").string()};
};

TEST_F(ProofSwitchTest, ShowsProvenTilesOnlyWhenThoseOfTheViewAreThere) {
    session::TerrainScene scene = open();
    const auto before = stream_of(scene);
    ASSERT_FALSE(before->options().find_proof);
    ProofSwitch tested(scene);
    bool has_changed = false;
    for (int i = 0; i < 30'000 && !has_changed; ++i) { // a minute at most
        EXPECT_EQ(stream_of(scene), before);
        has_changed = tested.update(size);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    ASSERT_TRUE(has_changed);
    const auto after = stream_of(scene);
    ASSERT_TRUE(after->options().find_proof);
    EXPECT_TRUE(after->options().find_proof({0, 0, 0}));
    for (const auto& request : view::tile_requests(scene.scene, scene.scene.camera(), size)) {
        EXPECT_EQ(request.stream, after);
        EXPECT_FALSE(request.used.empty());
        EXPECT_TRUE(request.missing.empty());
    }
    const auto light = tested.take_light();
    ASSERT_NE(light, nullptr);
    EXPECT_EQ(light->request.stream, after);
    EXPECT_FALSE(tested.update(size));
    EXPECT_EQ(tested.take_light(), nullptr) << "once";
    EXPECT_EQ(tested.progress().label, "");
    EXPECT_TRUE(stream_of(open())->options().find_proof) << "the next start has them at once";
}

// Its tiles would take memory as long as the window is open.
TEST_F(ProofSwitchTest, NothingOfTheViewerKeepsTheFirstStream) {
    session::TerrainScene scene = open();
    const std::weak_ptr<scene::TileStream> before = stream_of(scene);
    ViewerOptions options;
    options.proves_errors = true;
    Viewer viewer(scene, test::open_path(scene, "flyover").value(), size, options);
    for (int i = 0; i < 30'000 && !stream_of(scene)->options().find_proof; ++i) {
        viewer.advance(0.01);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    EXPECT_TRUE(stream_of(scene)->options().find_proof);
    EXPECT_TRUE(before.expired());
    EXPECT_NE(viewer.take_light(), nullptr);
}

TEST_F(ProofSwitchTest, LeavesAProvenTerrainAsItIs) {
    {
        session::TerrainScene scene = open();
        session::Log silent;
        ASSERT_TRUE(session::make_proofs(*scene.source, 0, silent, {}));
    }
    session::TerrainScene scene = open();
    ASSERT_TRUE(stream_of(scene)->options().find_proof);
    ProofSwitch tested(scene);
    for (int i = 0; i < 50; ++i) {
        EXPECT_FALSE(tested.update(size));
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
}

TEST_F(ProofSwitchTest, StopsWithTheViewerAndGoesOnAtTheNextStart) {
    session::TerrainScene scene = open();
    { const ProofSwitch stopped(scene); }
    ProofSwitch tested(scene);
    bool has_changed = false;
    for (int i = 0; i < 30'000 && !has_changed; ++i) {
        has_changed = tested.update(size);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    EXPECT_TRUE(has_changed);
}

TEST_F(ProofSwitchTest, NotesWhyNothingCanBeProven) {
    session::TerrainScene scene = open();
    const test::EnvironmentVariable no_cache("XDG_CACHE_HOME", "");
    const test::EnvironmentVariable no_home("HOME", "");
    const auto before = stream_of(scene);
    ProofSwitch tested(scene);
    struct Kept : session::Log {
        void message(session::MessageKind /*kind*/, std::string_view sentence) override {
            notes.emplace_back(sentence);
        }
        std::vector<std::string> notes;
    } log;
    for (int i = 0; i < 30'000 && log.notes.empty(); ++i) {
        EXPECT_FALSE(tested.update(size));
        tested.relay_to(log);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    EXPECT_THAT(log.notes, testing::ElementsAre(testing::HasSubstr("no absolute path found")));
    EXPECT_EQ(stream_of(scene), before);
}

} // namespace
} // namespace reljef::app
