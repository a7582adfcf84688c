// The ground of terrains that are read part by part: it is the finer the nearer one came.
#include "engine/session/ground.h"

#include <array>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/session/frame_maker.h"
#include "engine/session/streaming.h"
#include "engine/view/select.h"
#include "tests/session/made_session.h"
#include "tests/support/process_state.h"
#include "tests/support/temporary_folder.h"

namespace reljef::app {
namespace {

constexpr glm::ivec2 small_picture{160, 120};

/// Loads tiles, and draws nothing.
class TilesOnly : public session::FrameMaker {
public:
    void wait_for_tiles(const scene::Scene& scene, const std::stop_token& stop) override {
        session::Log silent;
        session::wait_for_tiles(scene, small_picture, selector, silent, stop);
    }
    Result<Image> draw(const scene::Scene& /*scene*/,
                       const ParallelOptions& /*parallel*/) override {
        return Error{"nothing is drawn"};
    }
    Result<HitBuffer> draw_hits(const scene::Scene& /*scene*/,
                                const ParallelOptions& /*parallel*/) override {
        return Error{"nothing is drawn"};
    }
    [[nodiscard]] std::string stats() const override { return {}; }

    view::FrameSelector selector;
};

/// A plateau at 1000 m, 2.8 km wide, with a canyon through its middle from south to north whose
/// floor, at 0 m, is three samples wide. It is read part by part.
class StreamedCanyon : public testing::Test {
protected:
    [[nodiscard]] session::TerrainScene
    scene_of(terrain::PlacementKind placement = terrain::PlacementKind::plane) const {
        constexpr int side = 257;
        std::string text = fmt::format("ncols {0}\nnrows {0}\nxllcenter 10\nyllcenter 0\n"
                                       "cellsize 0.0001\n",
                                       side);
        for (int i = 0; i < side * side; ++i) {
            text += std::abs(i % side - side / 2) <= 1 ? "0 " : "1000 ";
        }
        folder_.write("canyon.prj", R"(GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",)"
                                    R"(6378137,298.257223563]],PRIMEM["Greenwich",0],)"
                                    R"(UNIT["degree",0.0174532925199433]])");
        session::SourceOptions choice;
        choice.terrain = folder_.write("canyon.asc", text).string();
        choice.memory_megabytes = 1;
        choice.placement = placement;
        choice.streamed = true;
        auto source = test::open_terrain(choice);
        EXPECT_TRUE(source) << (source ? "" : source.error().message);
        EXPECT_TRUE(source->stream);
        return std::move(*test::make_scene(std::move(*source), choice, session::SceneOptions{}));
    }

    test::TemporaryFolder folder_;
    test::EnvironmentVariable cache_{"XDG_CACHE_HOME", (folder_.path() / "cache").string()};
};

scene::CameraPath northward_path(glm::dvec3 start) {
    const glm::dvec3 north(0.0, 300.0, 0.0);
    return *scene::CameraPath::create(
        {{0.0, start, start + north}, {1.0, start + north, start + 2.0 * north}});
}

TEST_F(StreamedCanyon, FramesOfAFlightAreRaisedOverTheFineGroundOnly) {
    session::TerrainScene scene = scene_of();
    const scene::CameraPath path = northward_path({0.0, -300.0, 5.0});
    TilesOnly maker;
    for (int i = 0; i < 3; ++i) {
        EXPECT_FALSE(session::fly_above_ground(scene, path, i, 3, maker, {})) << i;
        EXPECT_DOUBLE_EQ(scene.scene.camera().eye.z, 5.0) << i;
    }
}

TEST_F(StreamedCanyon, WhatARaisedFrameShowsIsThere) {
    session::TerrainScene scene = scene_of();
    const scene::CameraPath path = northward_path({500.0, -300.0, 200.0});
    TilesOnly maker;
    EXPECT_NEAR(session::fly_above_ground(scene, path, 0, 2, maker, {}).metres,
                800.0 + session::min_clearance(scene), 1e-9);
    const view::FrameView frame = view::select(scene.scene, small_picture);
    ASSERT_EQ(frame.requests.size(), 1U);
    EXPECT_TRUE(frame.requests.front().missing.empty());
}

TEST_F(StreamedCanyon, ACameraInTheFineCanyonStaysWhereTheOverviewHasRock) {
    for (const auto placement :
         {terrain::PlacementKind::plane, terrain::PlacementKind::ellipsoid}) {
        session::TerrainScene scene = scene_of(placement);
        auto& camera = *scene.camera->get<scene::Camera>();
        camera.eye = {0.0, -300.0, 5.0};
        camera.target = {0.0, 0.0, 5.0};
        const scene::Camera before = camera;
        TilesOnly maker;
        EXPECT_FALSE(session::stand_above_ground(scene, maker, {}));
        EXPECT_EQ(camera, before);
    }
}

TEST_F(StreamedCanyon, ACameraUnderThePlateauIsLiftedUnlessItMayBeThere) {
    session::TerrainScene scene = scene_of();
    auto& camera = *scene.camera->get<scene::Camera>();
    camera.eye = {500.0, -300.0, 200.0};
    camera.target = {500.0, 0.0, 100.0};
    const scene::Camera before = camera;
    TilesOnly maker;
    EXPECT_FALSE(session::stand_above_ground(scene, maker, {}, session::Underground::allowed));
    EXPECT_EQ(camera, before);
    const session::Lift lift = session::stand_above_ground(scene, maker, {});
    EXPECT_NEAR(lift.depth, 800.0, 1e-9);
    EXPECT_NEAR(lift.metres, 800.0 + session::min_clearance(scene), 1e-9);
    EXPECT_EQ(camera.eye, before.eye + lift.way);
    EXPECT_EQ(camera.target.z, before.target.z + lift.way.z);
    const scene::CameraPath path = northward_path(before.eye);
    EXPECT_FALSE(
        session::fly_above_ground(scene, path, 0, 2, maker, {}, session::Underground::allowed));
    EXPECT_EQ(camera.eye, before.eye);
    const session::Lift flown = session::fly_above_ground(scene, path, 0, 2, maker, {});
    EXPECT_NEAR(flown.depth, lift.depth, 1e-9);
    EXPECT_NEAR(flown.metres, lift.metres, 1e-9);
}

// From beside the terrain, as the pose overview looks, and from afar. Without finer tiles the
// ground is that of the overview, of which the exact ray cast knows.
TEST_F(StreamedCanyon, TheScaleIsKnownFromBesideTheTerrain) {
    for (const auto placement :
         {terrain::PlacementKind::plane, terrain::PlacementKind::ellipsoid}) {
        session::TerrainScene scene = scene_of(placement);
        const auto& terrain = *scene.terrain->get<scene::TerrainNode>();
        auto& camera = *scene.camera->get<scene::Camera>();
        scene::TerrainNode overview = terrain;
        overview.stream = nullptr;
        for (const double times : {1.0, 3.0, 100.0}) {
            scene::Camera away = camera;
            away.eye = camera.target + times * (camera.eye - camera.target);
            const auto requested = session::metres_per_pixel(overview, away, 120);
            const auto found = session::metres_per_pixel(terrain, away, 120);
            ASSERT_TRUE(requested && found) << times;
            EXPECT_NEAR(*found, *requested, 1e-3 * *requested) << times;
            away.target = away.eye + (away.eye - camera.target);
            EXPECT_FALSE(session::metres_per_pixel(terrain, away, 120)) << "nothing but sky";
        }
    }
}

} // namespace
} // namespace reljef::app
