#include "app/viewer/appearance/surface_switch.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>

#include <gtest/gtest.h>

#include "app/viewer/viewer.h"
#include "app/viewer/viewer_content.h"
#include "engine/session/streaming.h"
#include "engine/view/select.h"
#include "tests/app/made_hill.h"
#include "tests/session/made_waves.h"
#include "tests/support/process_state.h"
#include "tests/support/temporary_folder.h"

namespace reljef::app {
namespace {

void wait_for_maps(Viewer& viewer) {
    viewer.advance(1.0 / 60.0);
    while (viewer.is_preparing()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1)); // leaves the work a processor
        viewer.advance(1.0 / 60.0);
    }
}

struct ExaggerationTest : testing::Test {
    const scene::TerrainSurface& surface() {
        return *scene.terrain->get<scene::TerrainNode>()->surface;
    }
    glm::dvec3 eye() { return scene.camera->get<scene::Camera>()->eye; }
    static session::SceneOptions above_the_hill() {
        session::SceneOptions view;
        view.eye = glm::dvec3(0.0, 0.0, 100.0);
        view.target = glm::dvec3(10.0, 100.0, 50.0);
        return view;
    }

    session::TerrainScene scene = hill_scene(above_the_hill());
    Viewer viewer{scene, scene::orbit_path(scene.bounds, 10.0), {400, 300}};
};

TEST_F(ExaggerationTest, RaisesTheGroundAndLeavesTheEye) {
    const glm::dvec3 before = eye();
    viewer.set_exaggeration(1.5);
    EXPECT_EQ(viewer.exaggeration(), 1.5);
    viewer.take_redraw();
    wait_for_maps(viewer);
    EXPECT_TRUE(viewer.take_redraw());
    EXPECT_EQ(surface().placement().exaggeration(), 1.5);
    EXPECT_NEAR(*surface().height_at(0.0, 0.0), 90.0, 1e-6); // 60 m of float heights
    EXPECT_EQ(scene.bounds.high.z, scene.terrain->world_bounds().high.z);
    EXPECT_EQ(eye(), before);
    EXPECT_NE(viewer.take_light(), nullptr);
}

TEST_F(ExaggerationTest, RaisesWallsAndAirWithTheGround) {
    session::SceneOptions view = above_the_hill();
    view.base = session::BaseKind::solid;
    session::TerrainScene block = hill_scene(view);
    Viewer of_block{block, scene::orbit_path(block.bounds, 10.0), {400, 300}};
    const auto top_of_walls = [&] {
        const auto& positions = block.terrain->get<scene::TerrainNode>()->base->mesh->positions;
        return std::max_element(positions.begin(), positions.end(),
                                [](auto a, auto b) { return a.z < b.z; })
            ->z;
    };
    EXPECT_NEAR(top_of_walls(), 10.0, 1e-3);
    of_block.set_exaggeration(4.0);
    wait_for_maps(of_block);
    EXPECT_NEAR(top_of_walls(), 40.0, 1e-3);
    EXPECT_EQ(block.scene.sky()->base, block.bounds.low.z);
    EXPECT_EQ(block.scene.sky()->air_height, 1.5 * block.bounds.size().z);
}

TEST_F(ExaggerationTest, TheSkyFollowsTheSun) {
    viewer.set_sun({90.0, 4.0});
    wait_for_maps(viewer);
    const auto& light = *scene.light->get<scene::Light>();
    const scene::Daylight low = scene::daylight_at(4.0, scene::default_turbidity);
    EXPECT_EQ(light.altitude, 4.0);
    EXPECT_EQ(light.color, low.sun);
    EXPECT_EQ(light.ambient, low.ambient);
    EXPECT_EQ(scene.scene.sky()->zenith, low.sky.zenith);
}

TEST_F(ExaggerationTest, LiftsTheEyeAboveGroundThatRisesOverIt) {
    viewer.set_exaggeration(3.0);
    wait_for_maps(viewer);
    EXPECT_GT(eye().z, 180.0);
}

TEST_F(ExaggerationTest, TheLastOfManyRequestsIsShown) {
    for (double factor = 1.0; factor < 4.0; factor += 0.25) {
        viewer.set_exaggeration(factor);
        viewer.advance(1.0 / 60.0);
    }
    wait_for_maps(viewer);
    EXPECT_EQ(surface().placement().exaggeration(), 3.75);
}

// A scene that began with fewer samples keeps what was changed meanwhile.
TEST_F(ExaggerationTest, FinerSamplesAreShownAsTheCoarseOnesWere) {
    terrain::Terrain finer = surface().terrain();
    finer.heightfield.heights = Grid<float>(65, 65, 20.0F);
    finer.heightfield.spacing = {5.0, 5.0};
    viewer.set_exaggeration(2.0);
    viewer.refine(std::make_shared<const terrain::Terrain>(finer));
    ASSERT_TRUE(viewer.act(SetRamp{"swiss"}));
    const glm::dvec3 before = eye();
    wait_for_maps(viewer);
    EXPECT_EQ(surface().heightfield().heights.cols(), 65);
    EXPECT_EQ(surface().placement().exaggeration(), 2.0);
    EXPECT_EQ(surface().ramp(), *terrain::named_ramp("swiss"));
    EXPECT_NEAR(*surface().height_at(0.0, 0.0), 40.0, 1e-6);
    EXPECT_EQ(eye(), before);
    viewer.set_exaggeration(1.0);
    wait_for_maps(viewer);
    EXPECT_EQ(surface().heightfield().heights.cols(), 65);
}

TEST_F(ExaggerationTest, TheLastOfManySunsIsShown) {
    for (int azimuth = 0; azimuth < 180; ++azimuth) {
        viewer.set_sun({static_cast<double>(azimuth), 30.0});
    }
    wait_for_maps(viewer);
    const scene::Light light = *scene.light->get<scene::Light>();
    EXPECT_EQ(light.azimuth, 179.0);
    EXPECT_EQ(light.altitude, 30.0);
    EXPECT_EQ(viewer.light(), light);
}

TEST_F(ExaggerationTest, ImageryIsBlendedAndStaysWithOtherChanges) {
    ASSERT_TRUE(viewer.act(SetImageryShare{0.25}));
    EXPECT_EQ(viewer.imagery_share(), 0.25);
    viewer.set_exaggeration(2.0);
    wait_for_maps(viewer);
    EXPECT_EQ(surface().imagery_share(), 0.25);
    ASSERT_TRUE(viewer.act(SetRamp{"swiss"}));
    wait_for_maps(viewer);
    EXPECT_EQ(surface().imagery_share(), 0.25);
    EXPECT_EQ(surface().ramp().name, "swiss");
}

TEST_F(ExaggerationTest, ColoursChangeAndTheHeightsStay) {
    const double height = *surface().height_at(0.0, 0.0);
    ASSERT_TRUE(viewer.act(SetRamp{"swiss"}));
    EXPECT_EQ(viewer.ramp().name, "swiss");
    viewer.set_exaggeration(2.0); // keeps the colours
    wait_for_maps(viewer);
    EXPECT_EQ(surface().ramp().name, "swiss");
    EXPECT_NEAR(*surface().height_at(0.0, 0.0), 2.0 * height, 1e-6); // of float heights
    EXPECT_FALSE(viewer.act(SetRamp{"mauve"}));
    EXPECT_EQ(viewer.ramp().name, "swiss");
}

TEST_F(ExaggerationTest, GrainAndContoursChangeInFlight) {
    auto& terrain = *scene.terrain->get<scene::TerrainNode>();
    EXPECT_EQ(terrain.grain, 0.0F);
    ASSERT_TRUE(viewer.act(SetGrain{0.75}));
    EXPECT_EQ(terrain.grain, 0.75F);
    EXPECT_TRUE(viewer.take_redraw());
    EXPECT_EQ(content_of(viewer, scene, {400, 300}).appearance.grain, 0.75);
    ASSERT_TRUE(viewer.act(SetContours{20.0}));
    EXPECT_TRUE(viewer.take_redraw());
    EXPECT_EQ(content_of(viewer, scene, {400, 300}).appearance.contours, 20.0);
    EXPECT_TRUE(content_of(viewer, scene, {400, 300}).appearance.labels_contours);
    ASSERT_TRUE(viewer.act(SetEyeDome{0.3}));
    EXPECT_TRUE(viewer.take_redraw());
    EXPECT_EQ(content_of(viewer, scene, {400, 300}).appearance.eye_dome, 0.3);
    ASSERT_TRUE(viewer.act(SetContourLabels{false}));
    EXPECT_TRUE(viewer.take_redraw());
    EXPECT_FALSE(content_of(viewer, scene, {400, 300}).appearance.labels_contours);
    viewer.set_exaggeration(2.0);
    wait_for_maps(viewer);
    EXPECT_EQ(terrain.grain, 0.75F) << "of the new surface, too";
}

// Grain on one colour looks like gravel; what the user names stays.
TEST_F(ExaggerationTest, OneColourHasNoGrainUnlessTheUserSetsIt) {
    session::SceneOptions view = above_the_hill();
    view.default_grain = 1.0;
    session::TerrainScene usual = hill_scene(view);
    Viewer of_usual{usual, scene::orbit_path(usual.bounds, 10.0), {400, 300}};
    const auto grain_with = [&](const char* ramp) {
        EXPECT_TRUE(of_usual.act(SetRamp{ramp}));
        wait_for_maps(of_usual);
        return usual.terrain->get<scene::TerrainNode>()->grain;
    };
    EXPECT_EQ(grain_with("swiss"), 1.0F);
    EXPECT_EQ(grain_with("clay"), 0.0F);
    EXPECT_EQ(grain_with("relief"), 1.0F);
    ASSERT_TRUE(of_usual.act(SetGrain{0.5}));
    EXPECT_EQ(grain_with("clay"), 0.5F);
}

// The truth has neither grain nor contours.
TEST_F(ExaggerationTest, ComparisonsHideGrainAndContours) {
    const auto& terrain = *scene.terrain->get<scene::TerrainNode>();
    ASSERT_TRUE(viewer.act(SetGrain{1.0}));
    viewer.advance(1.0 / 60.0);
    EXPECT_EQ(scene::shown_grain(terrain), 1.0F);
    viewer.take_redraw();
    ASSERT_TRUE(viewer.act(SetComparison{CompareWith::truth}));
    viewer.advance(1.0 / 60.0);
    EXPECT_EQ(scene::shown_grain(terrain), 0.0F);
    EXPECT_TRUE(viewer.take_redraw());
    ASSERT_TRUE(viewer.act(SetComparison{CompareWith::nothing}));
    viewer.advance(1.0 / 60.0);
    EXPECT_EQ(scene::shown_grain(terrain), 1.0F);
}

TEST_F(ExaggerationTest, ALowSunIsWarmAndItsSkyFollows) {
    const auto warmth = [](glm::vec3 color) { return color.r / color.b; };
    ASSERT_TRUE(viewer.act(SetSun{200.0, 60.0}));
    wait_for_maps(viewer);
    const scene::Light high = *scene.light->get<scene::Light>();
    const scene::Sky noon = *scene.scene.sky();
    ASSERT_TRUE(viewer.act(SetSun{200.0, 5.0}));
    wait_for_maps(viewer);
    const scene::Light low = *scene.light->get<scene::Light>();
    EXPECT_GT(warmth(low.color), warmth(high.color));
    EXPECT_NE(scene.scene.sky()->horizon, noon.horizon);
    EXPECT_EQ(scene.scene.sky()->visibility, noon.visibility);
    EXPECT_EQ(low.is_sky_hidden, high.is_sky_hidden);
    ASSERT_TRUE(viewer.act(SetVisibility{1234.0}));
    ASSERT_TRUE(viewer.act(SetTurbidity{6.0}));
    wait_for_maps(viewer);
    EXPECT_EQ(scene.surroundings.turbidity, 6.0);
    EXPECT_EQ(scene.scene.sky()->visibility, 1234.0);
    EXPECT_NE(scene.light->get<scene::Light>()->color, low.color);
}

// A terrain that is read tile by tile, with the viewer.
class StreamedSurfaceTest : public testing::Test {
protected:
    StreamedSurfaceTest() {
        test::write_waves(folder_.path() / "waves.tif", 2300, 600);
        session::SourceOptions choice;
        choice.terrain = (folder_.path() / "waves.tif").string();
        choice.memory_megabytes = 8;
        choice.streamed = true;
        choice.index = session::IndexUse::existing;
        session::Log silent;
        auto opened = session::open_scene(choice, {}, silent);
        EXPECT_TRUE(opened) << (opened ? "" : opened.error().message);
        scene = std::move(*opened);
    }
    [[nodiscard]] const scene::TerrainNode& node() const {
        return *scene.terrain->get<scene::TerrainNode>();
    }
    void open_viewer(bool proves_errors) {
        ViewerOptions options;
        options.proves_errors = proves_errors;
        viewer.emplace(scene, scene::orbit_path(scene.bounds, 10.0), glm::ivec2(160, 120), options);
    }
    void expect_whole_view() const {
        for (const auto& request :
             view::tile_requests(scene.scene, scene.scene.camera(), {160, 120})) {
            EXPECT_EQ(request.stream, node().stream);
            EXPECT_FALSE(request.used.empty());
            EXPECT_TRUE(request.missing.empty());
        }
    }

    test::TemporaryFolder folder_;
    test::EnvironmentVariable cache_{"XDG_CACHE_HOME", (folder_.path() / "cache").string()};
    session::TerrainScene scene;
    std::optional<Viewer> viewer;
};

TEST_F(StreamedSurfaceTest, ChangesWhenTheTilesOfTheViewAreThere) {
    open_viewer(false);
    const std::weak_ptr<scene::TileStream> before = node().stream;
    ASSERT_TRUE(viewer->act(SetExaggeration{2.0}));
    ASSERT_TRUE(viewer->act(SetRamp{"swiss"}));
    EXPECT_EQ(node().stream, before.lock());
    wait_for_maps(*viewer);
    EXPECT_EQ(node().surface->placement().exaggeration(), 2.0);
    EXPECT_EQ(node().surface->ramp().name, "swiss");
    EXPECT_EQ(&node().stream->maker().overview(), node().surface.get());
    EXPECT_EQ(scene.bounds.high.z, scene.terrain->world_bounds().high.z);
    EXPECT_TRUE(before.expired()) << "its tiles would take memory";
    expect_whole_view();
    const auto light = viewer->take_light();
    ASSERT_NE(light, nullptr);
    EXPECT_EQ(light->request.stream, node().stream);
    EXPECT_EQ(light->request.surface, node().surface);
}

TEST_F(StreamedSurfaceTest, TheLastOfManyRequestsIsShown) {
    open_viewer(false);
    for (double factor = 1.25; factor < 4.0; factor += 0.25) {
        viewer->set_exaggeration(factor);
        for (int i = 0; i < 20; ++i) {
            viewer->advance(1.0 / 60.0);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }
    wait_for_maps(*viewer);
    EXPECT_EQ(node().surface->placement().exaggeration(), 3.75);
    EXPECT_EQ(viewer->exaggeration(), 3.75);
    expect_whole_view();
}

// Whichever is ready first, the other one keeps it.
TEST_F(StreamedSurfaceTest, KeepsProofsThatArriveMeanwhile) {
    open_viewer(true);
    double factor = 1.5;
    for (int i = 0; i < 30'000 && !node().stream->options().find_proof; ++i) {
        if (!viewer->is_preparing()) {
            viewer->set_exaggeration(factor = 3.5 - factor);
        }
        viewer->advance(1.0 / 60.0);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    viewer->set_exaggeration(2.5);
    wait_for_maps(*viewer);
    EXPECT_EQ(node().surface->placement().exaggeration(), 2.5);
    ASSERT_TRUE(node().stream->options().find_proof);
    EXPECT_TRUE(node().stream->options().find_proof({0, 0, 0}));
    EXPECT_EQ(&node().stream->maker().overview(), node().surface.get());
}

} // namespace
} // namespace reljef::app
