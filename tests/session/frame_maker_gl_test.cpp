#include "engine/session/frame_maker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/session/prepared_maps.h"
#include "tests/app/made_hill.h"
#include "tests/support/temporary_folder.h"

namespace reljef::session {
namespace {

constexpr glm::ivec2 picture{64, 48};

const std::string utm_31_prj =
    R"(PROJCS["UTM_31N",GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,)"
    R"(298.257223563]],PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]],)"
    R"(PROJECTION["Transverse_Mercator"],PARAMETER["False_Easting",500000.0],)"
    R"(PARAMETER["False_Northing",0.0],PARAMETER["Central_Meridian",3.0],)"
    R"(PARAMETER["Scale_Factor",0.9996],PARAMETER["Latitude_Of_Origin",0.0],UNIT["Meter",1.0]])";

Device osmesa_device() {
    return std::move(*Device::create({.context = session::BackendKind::osmesa, .size = picture}));
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
        view::PreparedLight light = view::prepare_light(*request);
        std::fill(light.lit.samples().begin(), light.lit.samples().end(), Rgba8{255, 0, 0, 255});
        std::fill(light.sun.samples().begin(), light.sun.samples().end(), Rgba8{0, 0, 0, 255});
        renderer.add_light(std::make_shared<const view::PreparedLight>(light));
        ASSERT_TRUE(renderer.draw(scene.scene, true));
        const Image image = renderer.read_color();
        const Rgba8 middle = image(image.cols() / 2, image.rows() / 2);
        EXPECT_GT(middle.r, 2 * middle.g) << in_parts << ", seen through air";
    }
}

/// Waves of 65 samples a side, in UTM.
TerrainScene waves_with(double spacing, terrain::PlacementKind placement,
                        const test::TemporaryFolder& folder) {
    constexpr int side = 65;
    std::string text = fmt::format("ncols {0}\nnrows {0}\nxllcenter 400000\nyllcenter 5000000\n"
                                   "cellsize {1}\n",
                                   side, spacing);
    for (int i = 0; i < side * side; ++i) {
        text += fmt::format("{:.6g} ", spacing * (10.0 + 6.0 * std::sin(0.2 * (i % side)) *
                                                             std::cos(0.15 * (i / side))));
    }
    SourceOptions source;
    source.terrain = folder.write("waves.asc", text).string();
    source.placement = placement;
    folder.write("waves.prj", utm_31_prj);
    Log silent;
    SceneOptions view;
    view.size = picture;
    view.max_error = 0.1; // a pixel shows up to two samples and a half
    return std::move(*open_scene(source, view, silent));
}

void expect_same_places(const HitBuffer& a, const HitBuffer& b) {
    int terrain = 0;
    int sky = 0; // in one of them
    for (std::size_t i = 0; i < a.size(); ++i) {
        const Hit& x = a.samples()[i];
        const Hit& y = b.samples()[i];
        sky += x.is_sky() != y.is_sky() ? 1 : 0;
        if (!x.is_sky() && !y.is_sky()) {
            ++terrain;
            ASSERT_NEAR(x.col, y.col, 0.5);
            ASSERT_NEAR(x.row, y.row, 0.5);
        }
    }
    EXPECT_LT(sky, 5);
    EXPECT_GT(terrain, 500);
}

// On an ellipsoid, rays that begin far beyond a small terrain used to be halved for minutes.
TEST(TinyTerrainsGl, AreDrawnAsThoseOfAMetre) {
    const test::TemporaryFolder folder;
    Log silent;
    for (const auto& [placement, spacings] :
         {std::pair{terrain::PlacementKind::plane, std::array{1e-3, 1e-6}},
          std::pair{terrain::PlacementKind::ellipsoid, std::array{1e-3, 1.1e-4}}}) {
        const TerrainScene large = waves_with(1.0, placement, folder);
        const auto expected = DeviceFrames(osmesa_device(), silent).draw_hits(large.scene, {});
        const auto expected_truth = TruthFrames(picture, 1, silent).draw_hits(large.scene, {});
        ASSERT_TRUE(expected && expected_truth);
        for (const double spacing : spacings) {
            const TerrainScene tiny = waves_with(spacing, placement, folder);
            const auto hits = DeviceFrames(osmesa_device(), silent).draw_hits(tiny.scene, {});
            const auto truth = TruthFrames(picture, 1, silent).draw_hits(tiny.scene, {});
            ASSERT_TRUE(hits && truth);
            expect_same_places(*hits, *expected);
            expect_same_places(*truth, *expected_truth);
        }
    }
}

// The rounding of positions there is a share of a sample that no halving makes straight.
TEST(TinyTerrains, AreRefusedOnTheEllipsoidBelowItsPrecision) {
    const test::TemporaryFolder folder;
    for (const double spacing : {1e-5, 1e-6}) {
        waves_with(spacing, terrain::PlacementKind::plane, folder);
        SourceOptions source;
        source.terrain = (folder.path() / "waves.asc").string();
        Log silent;
        const auto scene = open_scene(source, {}, silent);
        ASSERT_FALSE(scene);
        EXPECT_NE(scene.error().message.find("at least 0.0001 m or placement plane was expected"),
                  std::string::npos)
            << scene.error().message;
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
